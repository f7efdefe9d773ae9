// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
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

/// Step by step, all pixels each.
Bits plainly_grown(const Bits& white, const std::vector<LineWidth>& widths, int columns, const Bits& before) {
  Bits lines = before;
  for (int step = 1; step <= 16; ++step) {
    const Bits last = lines;
    for_each_set_bit(white.view(), [&](int x, int y) {
      int widest = 0;
      for (int i = 0; i < columns; ++i) {
        widest = std::max<int>(widest, widths[static_cast<std::size_t>(y / 8 * columns + i)].slanted);
      }
      if (widest < step * 32) return;
      for (int v = y - 1; v <= y + 1; ++v) {
        for (int u = x - 1; u <= x + 1; ++u) {
          if (last.view().get(u, v)) lines.view().set(x, y, true);
        }
      }
    });
  }
  return lines;
}

}  // namespace

TEST_CASE("lines grow in white by half of their width, row of blocks by row of blocks, at every size") {
  unsigned seed = 0;
  int grown = 0;
  for (const auto& [w, h] : test::awkward_sizes()) {
    if (w == 0 || h == 0) continue;
    for (const int percent : {45, 70, 95}) {
      std::mt19937 random(++seed);
      const int height = h * 9;
      const int columns = (w + 7) / 8, rows = (height + 7) / 8;
      std::vector<LineWidth> widths(static_cast<std::size_t>(columns * rows));
      for (LineWidth& width : widths) {
        width.slanted = static_cast<std::uint16_t>(random() % 16 == 0 ? 65535 : random() % 8 * 24);
      }
      const Bits white = test::random_bits(w, height, percent, seed);
      const Bits before = test::random_bits(w, height, 1, seed + 100);
      const auto expected = ascii(plainly_grown(white, widths, columns, before));
      for (const Kernels& kernels : test::all_tables()) {
        CAPTURE(kernels.name);
        Bits after = before;
        Bits scratch = test::random_bits(w, height, 50, seed + 1);
        grow_into_white(white.view(), {widths.data(), columns, rows, columns}, after.view(), scratch.view(), kernels);
        REQUIRE(ascii(after) == expected);
        grown += count(after.view()) - count(before.view());
      }
    }
  }
  CHECK(grown > 1000);
}

TEST_CASE("the border is trimmed twice by the rule, at every size") {
  unsigned seed = 0;
  int trimmed = 0;
  for (const auto& [w, h] : test::awkward_sizes()) {
    for (const int percent : {20, 80, 98}) {
      std::mt19937 random(++seed);
      Gray luma(w, h * 3);
      for (std::uint8_t& v : luma.samples) v = static_cast<std::uint8_t>(percent == 80 ? random() % 3 : random());
      const Bits before = test::random_bits(w, h * 3, percent, seed);
      const auto expected = ascii(plainly_trimmed(luma, before));
      for (const Kernels& kernels : test::all_tables()) {
        CAPTURE(kernels.name);
        Bits after = before;
        Bits scratch = test::random_bits(w, h * 3, 50, seed + 1);
        trim_to_half_level(luma.view(), after.view(), scratch.view(), kernels);
        REQUIRE(ascii(after) == expected);
        trimmed += count(before.view()) - count(after.view());
      }
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
