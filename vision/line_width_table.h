// SPDX-License-Identifier: Apache-2.0
// How wide a field line looks at a pixel of the working image: the one thing that vision's integer stages need of
// geometry. Made anew for each frame from lens and attitude, on a coarse grid, quantised to 1/16 working pixel.
#pragma once

#include <array>
#include <cstdint>

#include "vision/image/image_view.h"
#include "vision/lens/camera_pose.h"

namespace touchline {

inline constexpr int width_block_px = 8;  // the width changes slowly: 8x8 working pixels share one entry

/// Widths for a line that crosses the row (column) at a right angle on the ground; a slanting line looks wider.
/// 0 means: no ground there, outside the lens, or a line thinner than 1/16 pixel.
struct LineWidth {
  std::uint16_t across_row = 0;     // extent along the row, 1/16 working pixel
  std::uint16_t across_column = 0;  // extent along the column, 1/16 working pixel
};

using LineWidthView = ImageView<const LineWidth>;  // one entry per block of width_block_px squared

/// Fills `table` ((width / 8) x (height / 8) entries, rounded up) for a line of `line_width_m`.
void make_line_width_table(const GroundProjection& projection, int frame_width, int frame_height, int work_width,
                           int work_height, float line_width_m, ImageView<LineWidth> table);

}  // namespace touchline
