// SPDX-License-Identifier: Apache-2.0
// Which working pixels can see the carpet: below the horizon and nearer than the range that is of use. Geometry alone;
// no pixel is looked at.
#pragma once

#include "vision/image/bit_image.h"
#include "vision/lens/camera_pose.h"
#include "vision/ray_grid.h"

namespace touchline {

/// Sets the pixels of `ground` that are set in `seen` and whose centre sees the carpet within `max_range_m` of the
/// point below the camera. The rays' steepness is quantised to 2^-14 and interpolated between the grid's corners in
/// integers.
void make_ground_mask(const RayGridView& grid, const CameraPose& pose, float max_range_m, ConstBitView seen,
                      BitView ground);

}  // namespace touchline
