// SPDX-License-Identifier: Apache-2.0
#include "vision/short_pieces.h"

#include <doctest/doctest.h>

#include <algorithm>
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
struct OwnPieceMemory {
  std::vector<std::uint16_t> runs, pieces;
  std::vector<GridPoint> corners, stack;
  OwnPieceMemory(int width, std::size_t room)
      : runs(6 * max_skeleton_runs(width)),
        pieces(3 * max_open_pieces(width)),
        corners(2 * max_open_pieces(width)),
        stack(room) {}
  [[nodiscard]] PieceMemory memory() { return {runs, pieces, corners, stack}; }
};

Outcome run(const Bits& image, LineWidth width, std::size_t room = 64) {
  Outcome o{image, {}};
  const std::vector<LineWidth> widths(
      static_cast<std::size_t>((o.skeleton.width / 8 + 1) * (o.skeleton.height / 8 + 1)), width);
  const LineWidthView table{widths.data(), o.skeleton.width / 8 + 1, o.skeleton.height / 8 + 1,
                            o.skeleton.width / 8 + 1};
  OwnPieceMemory own(o.skeleton.width, room);
  o.counts = remove_short_pieces(o.skeleton.view(), table, 5, own.memory());
  return o;
}
Outcome run(const std::vector<std::string_view>& rows, LineWidth width, std::size_t room = 64) {
  return run(bits(rows), width, room);
}

/// Each piece followed from its first pixel, over a list.
Bits plain(const Bits& image, LineWidth width) {
  Bits left = image;
  Bits out = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!left.view().get(x, y)) continue;
      std::vector<std::pair<int, int>> piece = {{x, y}};
      left.view().set(x, y, false);
      int x0 = x, x1 = x, y1 = y;
      for (std::size_t i = 0; i < piece.size(); ++i) {
        for (int d = 0; d < 9; ++d) {
          const int nx = piece[i].first + d % 3 - 1, ny = piece[i].second + d / 3 - 1;
          if (!left.view().get(nx, ny)) continue;
          left.view().set(nx, ny, false);
          piece.emplace_back(nx, ny);
          x0 = std::min(x0, nx), x1 = std::max(x1, nx), y1 = std::max(y1, ny);
        }
      }
      const bool is_short = std::max(x1 - x0, y1 - y) + 1 < 5 ||
                            ((x1 - x0) * 16 < 3 * width.across_row && (y1 - y) * 16 < 3 * width.across_column);
      if (!is_short) continue;
      for (const auto& [px, py] : piece) out.view().set(px, py, false);
    }
  }
  return out;
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

TEST_CASE("random masks lose the pieces that a plain search finds") {
  unsigned seed = 0;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {2, 10, 25, 40, 60, 100}) {
      const Bits image = random_bits(w, h, percent, ++seed);
      for (const LineWidth width : {LineWidth{4, 2, 6}, LineWidth{30, 30, 42}, LineWidth{60, 90, 120}}) {
        REQUIRE(ascii(run(image, width, 4096).skeleton) == ascii(plain(image, width)));
      }
    }
  }
}

TEST_CASE("arms that meet far below are one piece") {
  const std::vector<std::string_view> comb = {
      "#.#.#.#.#.#.", "#.#.#.#.#.#.", "#.#.#.#.#.#.", "#.#.#.#.#.#.", ".#...#...#..", "..###.###...", ".....#......",
  };
  const Outcome o = run(comb, {48, 16, 50});
  CHECK(o.counts.kept == 1);
  CHECK(o.counts.removed == 0);
  CHECK(o.skeleton == bits(comb));
}

TEST_CASE("when a short piece finds no room, that is told, and the others are judged") {
  std::vector<std::string_view> rows(9, "#########");  // filled: many pixels wait
  rows.insert(rows.begin(), {"#........", "........."});
  rows.insert(rows.end(), {".........", "#........"});
  const Outcome o = run(rows, {320, 320, 450}, 4);
  CHECK(o.counts.overflowed == 1);
  CHECK(o.counts.removed == 3);
  CHECK(!o.skeleton.view().get(0, 0));
  CHECK(!o.skeleton.view().get(0, 12));
}
