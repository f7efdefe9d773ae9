// SPDX-License-Identifier: Apache-2.0
#include "vision/short_pieces.h"

#include <doctest/doctest.h>

#include <array>
#include <vector>

#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Outcome {
  Bits skeleton;
  PieceCounts counts;
};
Outcome run(const std::vector<std::string_view>& rows, LineWidth width, std::size_t room = 64) {
  Outcome o{bits(rows), {}};
  Bits scratch(o.skeleton.width, o.skeleton.height);
  const std::vector<LineWidth> widths(
      static_cast<std::size_t>((o.skeleton.width / 8 + 1) * (o.skeleton.height / 8 + 1)), width);
  const LineWidthView table{widths.data(), o.skeleton.width / 8 + 1, o.skeleton.height / 8 + 1,
                            o.skeleton.width / 8 + 1};
  std::vector<GridPoint> stack(room);
  o.counts = remove_short_pieces(o.skeleton.view(), table, 5, scratch.view(), stack);
  return o;
}

}  // namespace

TEST_CASE("pieces shorter than three line widths go, others stay as they are") {
  const std::vector<std::string_view> drawn = {
      "###.................", "....................", "......############..",
      ".#............#.....", "..#...........#.....", "...#................",
  };
  const Outcome o = run(drawn, {48, 48, 68});  // three pixels wide: nine is the least
  CHECK(ascii(o.skeleton) == ascii(bits({
                                 "....................",
                                 "....................",
                                 "......############..",
                                 "..............#.....",
                                 "..............#.....",
                                 "....................",
                             })));
  CHECK(o.counts.kept == 1);
  CHECK(o.counts.removed == 2);
}

TEST_CASE("far away, where a line is thin, the least number of pixels counts") {
  CHECK(count(run({"....", "####", "...."}, {4, 2, 6}).skeleton.view()) == 0);
  CHECK(count(run({".....", "#####", "....."}, {4, 2, 6}).skeleton.view()) == 5);
}

TEST_CASE("when a piece finds no room, it and all that follows are kept, and that is told") {
  std::vector<std::string_view> rows(9, "#########");  // filled: many pixels wait
  rows.insert(rows.begin(), {"#........", "........."});
  const Outcome o = run(rows, {320, 320, 450}, 4);
  CHECK(o.counts.overflowed == 1);
  CHECK(count(o.skeleton.view()) == 81);  // the speck above went before
}
