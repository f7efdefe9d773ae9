// SPDX-License-Identifier: Apache-2.0
// Every parameter of the vision chain: unit, default and reason. Lengths in pixels are working pixels of 320x240 and
// scale along with the working width.
#pragma once

#include <array>
#include <cstdint>

#include "platform/core/geometry.h"
#include "platform/core/static_vector.h"
#include "platform/core/status.h"
#include "vision/image/hsv.h"
#include "vision/image/kernels.h"

namespace touchline {

/// Of a point of a body mask: it may lie outside of the picture, but not without measure.
inline constexpr float max_mask_coordinate_px = 10000.0F;
inline constexpr std::size_t max_mask_polygons = 4;         // two feet, two hands
inline constexpr std::size_t max_mask_polygon_points = 12;  // enough for a foot's outline
using MaskPolygon = StaticVector<PixelPoint, max_mask_polygon_points>;

struct VisionConfig {
  int frame_width = 752;  // camera pixels; the paper's camera
  int frame_height = 480;
  int work_width = 320;  // working pixels; up to the storage's size
  int work_height = 240;
  int fifo_depth = 4;  // frames in the mean, 1..8 (paper section IV-A; the storage may allow fewer)

  /// Wider vectors where the processor has them (fastest_kernels() of platform/processor); the result is the same.
  Kernels kernels = portable_kernels();

  HsvRange green{28, 95, 40, 255, 12, 255};  // a wide gate: each frame finds its own range inside
  HsvRange yellow_post{18, 34, 110, 255, 60, 255};
  HsvRange white_post{0, 179, 0, 70, 140, 255};
  int green_erode_px = 3;   // kernel side, odd; removes specks of green outside the field
  int green_dilate_px = 5;  // kernel side, odd; closes the holes that lines of usual width leave
  int line_dilate_px = 3;   // joins both edges of a line
  int line_erode_px = 3;

  float line_width_m = 0.05F;     // of the field
  float circle_radius_m = 0.75F;  // of the field; 0: none
  float post_diameter_m = 0.10F;
  bool white_posts = false;  // search white posts in place of yellow ones

  int digestion_radius_px = 5;  // paper section IV-D
  int low_weight = 1, medium_weight = 10,
      high_weight = 100;  // low << medium << high: a long line must not eat a junction
  int spur_px = 6;        // a free-ended edge shorter than this is a spur

  float max_range_m = 6.0F;  // junctions farther than this are not reported: a pixel is then wider than a line
  StaticVector<MaskPolygon, max_mask_polygons> body_mask;  // camera pixels; where the robot sees itself
};

/// invalid_argument: a value is not finite or out of range, and `what` names the key, when not null.
Status check_config(const VisionConfig& config, const char** what);

}  // namespace touchline
