// SPDX-License-Identifier: Apache-2.0
// Pieces of skeleton too short to be a line: specks of the carpet, the penalty mark, the ball, a robot's toe. How short
// follows from the width of a line there.
#pragma once

#include <span>

#include "vision/graph.h"
#include "vision/image/bit_image.h"
#include "vision/line_width_table.h"

namespace touchline {

inline constexpr int least_length_in_widths = 3;  // a mark is one line width across, a ball at most two and a half

struct PieceCounts {
  int kept = 0;
  int removed = 0;
  int overflowed = 0;  // 1: a piece did not fit `stack`; it and all that follows were kept without a check
};

/// Removes from `skeleton` each 8-connected piece that extends over less than three line widths or less than `least_px`
/// pixels. `scratch` has the skeleton's size; `stack` bounds the pixels that wait while a piece is followed.
PieceCounts remove_short_pieces(BitView skeleton, LineWidthView widths, int least_px, BitView scratch,
                                std::span<GridPoint> stack);

}  // namespace touchline
