// SPDX-License-Identifier: Apache-2.0
// How wide a field line looks in one block of the working image (line_width_table.h tells how that follows).
#pragma once

#include <cstdint>

namespace touchline {

inline constexpr int width_block_px = 8;  // the width changes slowly: 8x8 working pixels share one entry

/// All 0: no ground there, outside the lens, or a line thinner than 1/16 pixel. 65535: that and more.
struct LineWidth {
  std::uint16_t across_row = 0;     // extent along the row of a line that runs along the column, 1/16 working pixel
  std::uint16_t across_column = 0;  // extent along the column of a line that runs along the row, 1/16 working pixel
  /// Extent along the row, and along the column, of a line at 45 degrees in the working image: the worse of both
  /// diagonals. A line steeper than 45 degrees is at most that wide along its row, a flatter one along its column.
  std::uint16_t slanted = 0;  // 1/16 working pixel
};

}  // namespace touchline
