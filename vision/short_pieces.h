// SPDX-License-Identifier: Apache-2.0
// Pieces of skeleton too short to be a line: specks of the carpet, the penalty mark, the ball, a robot's toe. How short
// follows from the width of a line there.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/graph.h"
#include "vision/image/bit_image.h"
#include "vision/line_width_table.h"

namespace touchline {

inline constexpr int least_length_in_widths = 3;  // a mark is one line width across, a ball at most two and a half

struct PieceCounts {
  int kept = 0;
  int removed = 0;
  int overflowed = 0;  // pieces that did not fit `stack` while they were taken away: some of their pixels are left
};

/// Runs of one row and of the one above, and the pieces that reach one of them.
constexpr std::size_t max_skeleton_runs(int width) { return static_cast<std::size_t>(width / 2 + 1); }
constexpr std::size_t max_open_pieces(int width) { return 2 * max_skeleton_runs(width); }

struct PieceMemory {
  std::span<std::uint16_t> runs;    // 6 max_skeleton_runs(width)
  std::span<std::uint16_t> pieces;  // 3 max_open_pieces(width)
  std::span<GridPoint> corners;     // 2 max_open_pieces(width)
  std::span<GridPoint> stack;       // bounds the pixels that wait while a piece is taken away
};

template <int W, int H>
struct PieceStorage {
  // A short piece is about as long as three lines are wide, so a hundred pixels; what waits of a blob is its rim. Only
  // noise comes near the largest piece there may be, and then some of its pixels are left and counted.
  static constexpr std::size_t max_waiting = std::size_t{W} * std::size_t{H} / 30;
  std::array<std::uint16_t, 6 * max_skeleton_runs(W)> runs{};
  std::array<std::uint16_t, 3 * max_open_pieces(W)> pieces{};
  std::array<GridPoint, 2 * max_open_pieces(W)> corners{};
  std::array<GridPoint, max_waiting> stack{};
  [[nodiscard]] PieceMemory memory() { return {runs, pieces, corners, stack}; }
};

/// Removes from `skeleton` each 8-connected piece that extends over less than three line widths or less than `least_px`
/// pixels. One pass over the rows joins their runs to pieces; a piece is judged when a row has none of it any more.
PieceCounts remove_short_pieces(BitView skeleton, LineWidthView widths, int least_px, const PieceMemory& memory);

}  // namespace touchline
