// SPDX-License-Identifier: Apache-2.0
// How wide a field line looks at a pixel of the working image: the one thing that vision's integer stages need of
// geometry. Made anew for each frame from the ray grid and the attitude, on a coarse grid, quantised to 1/16 working
// pixel.
//
// Lens and perspective stretch the ground differently in each direction, so a line's width depends on how it lies. With
// J = d ground / d pixel, a line along the image direction e has the extent  w |J e| / (|det J| |e_y|)  along the row
// and w |J e| / (|det J| |e_x|)  along the column.
#pragma once

#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/image/line_width.h"
#include "vision/lens/camera_pose.h"
#include "vision/ray_grid.h"

namespace touchline {

static_assert(width_block_px == ray_cell_px);

using LineWidthView = ImageView<const LineWidth>;  // one entry per block of width_block_px squared

/// Fills `table` ((width / 8) x (height / 8) entries, rounded up) for a line of `line_width_m`, at the centre of each
/// block.
void make_line_width_table(const RayGridView& grid, const CameraPose& pose, float line_width_m,
                           ImageView<LineWidth> table, const Kernels& kernels = portable_kernels());

}  // namespace touchline
