// SPDX-License-Identifier: Apache-2.0
// From skeleton pixels to points on the middle of a line, better than a working pixel, with their place on the ground.
// Both edges are found on the luma's profile across the line, and their distance on the ground is compared with the
// line's width: the strongest test there is of what is a line.
#pragma once

#include <span>

#include "vision/features.h"
#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/work_rays.h"

namespace touchline {

struct LinePointInput {
  ImageView<const std::uint8_t> luma;
  ConstBitView skeleton;
  ConstBitView line_mask;
  const WorkRays& rays;
  float line_width_m = 0.05F;
  float max_range_m = 6.0F;
  Kernels kernels = portable_kernels();
};

/// Skeleton pixels that made no point, by reason.
struct LinePointCounts {
  int considered = 0;
  int no_direction = 0;  // at a fork or an end: no stretch of skeleton to take a direction from
  int no_edge = 0;       // the profile does not fall to both sides, or the picture ends first
  int no_ground = 0;
  int wrong_width = 0;
  int dropped = 0;  // no room
};

/// The points of the line through pixels of the line mask (at most sixteen; others are left out), whose direction in
/// the image (working pixels, any length) is known: where the skeleton is too short or too bent to tell.
using FoundLinePoints = StaticVector<LinePoint, probe_lanes>;
void find_line_points_at(const LinePointInput& input, std::span<const WorkPoint> at, const WorkPoint& direction,
                         FoundLinePoints& points);

/// Fills `points`, evenly spread over the skeleton's pixels. `scratch` has the skeleton's size.
LinePointCounts find_line_points(const LinePointInput& input, BitView scratch,
                                 StaticVector<LinePoint, max_line_points>& points);

}  // namespace touchline
