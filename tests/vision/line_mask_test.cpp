// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <doctest/doctest.h>

#include "tests/support/ascii_image.h"

namespace touchline {

using test::ascii;
using test::Bits;
using test::bits;

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

}  // namespace

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
