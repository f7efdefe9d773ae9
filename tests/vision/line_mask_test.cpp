// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"

namespace touchline {

using test::ascii;
using test::Bits;
using test::bits;
using test::Gray;

namespace {

Bits closed(const Bits& lines, const Bits& carpet) {
  Bits out = lines;
  Bits scratch(lines.width, lines.height);
  close_lines(carpet.view(), 3, 3, out.view(), scratch.view());
  return out;
}

// Two lines at a sharp angle, a gap of a pixel or two between them.
const std::vector<std::string_view> wedge{
    "................",  //
    "..##########....",  //
    "..###...........",  //
    "....##..........",  //
    "......##........",  //
    "........##......",  //
    "................",
};

/// What trimming means, pixel by pixel.
Bits plainly_trimmed(const Gray& luma, const Bits& before) {
  Bits lines = before;
  for (int pass = 0; pass < 2; ++pass) {
    const Bits last = lines;
    const auto is_line = [&last](int x, int y) { return last.view().get(x, y); };
    for_each_set_bit(last.view(), [&](int x, int y) {
      if (is_line(x - 1, y) && is_line(x + 1, y) && is_line(x, y - 1) && is_line(x, y + 1)) return;
      int darkest = 255, brightest = 0;
      for (int v = std::max(y - 2, 0); v <= std::min(y + 2, luma.height - 1); ++v) {
        for (int u = std::max(x - 2, 0); u <= std::min(x + 2, luma.width - 1); ++u) {
          darkest = std::min<int>(darkest, luma.view().at(u, v));
          brightest = std::max<int>(brightest, luma.view().at(u, v));
        }
      }
      if (2 * luma.view().at(x, y) < darkest + brightest) lines.view().set(x, y, false);
    });
  }
  return lines;
}

}  // namespace

TEST_CASE("the border is trimmed twice by the rule, at every size") {
  unsigned seed = 0;
  int trimmed = 0;
  for (const auto& [w, h] : test::awkward_sizes()) {
    for (const int percent : {20, 80, 98}) {
      std::mt19937 random(++seed);
      Gray luma(w, h * 3);
      for (std::uint8_t& v : luma.samples) v = static_cast<std::uint8_t>(percent == 80 ? random() % 3 : random());
      const Bits before = test::random_bits(w, h * 3, percent, seed);
      Bits after = before;
      Bits scratch = test::random_bits(w, h * 3, 50, seed + 1);
      trim_to_half_level(luma.view(), after.view(), scratch.view());
      REQUIRE(ascii(after) == ascii(plainly_trimmed(luma, before)));
      trimmed += count(before.view()) - count(after.view());
    }
  }
  CHECK(trimmed > 1000);
}

TEST_CASE("carpet between two lines at a sharp angle stays carpet when the line mask is closed") {
  const Bits lines = bits(wedge);
  Bits carpet(lines.width, lines.height);
  for (int y = 0; y < lines.height; ++y) {
    for (int x = 0; x < lines.width; ++x) carpet.view().set(x, y, !lines.view().get(x, y));
  }
  CHECK(ascii(closed(lines, carpet)) == ascii(lines));
}

TEST_CASE("what is no carpet between two edges of a line is closed") {
  const Bits lines = bits(wedge);
  const Bits filled = closed(lines, Bits(lines.width, lines.height));
  CHECK(filled.view().get(5, 2));
  CHECK(filled.view().get(6, 2));
}

TEST_CASE("carpet that a line was found on stays line: closing takes out only what it has put in") {
  const Bits lines = bits(wedge);
  CHECK(ascii(closed(lines, lines)) == ascii(closed(lines, Bits(lines.width, lines.height))));
}

}  // namespace touchline
