// SPDX-License-Identifier: Apache-2.0
// A row of 8x8 blocks of the working image for the line width table (line_width_table.h): what its loop needs.
#pragma once

#include <cstdint>

namespace touchline {

/// The rays at the blocks' corners, above and below: blocks + 1 of each component; all zero where there is no ray.
struct BlockRow {
  const float* above[3] = {};
  const float* below[3] = {};
  int blocks = 0;
  float robot_from_camera[3][3] = {};
  float height = 0.0F;  // of the camera above the ground, m
  float line_width_m = 0.0F;
  std::int32_t* ground = nullptr;  // set to 1 where a block has ground, or could; else to 0, and the rest means nothing
  /// Of LineWidth, in sixteenths of a pixel: 0..65535.
  std::int32_t* across_row = nullptr;
  std::int32_t* across_column = nullptr;
  std::int32_t* slanted = nullptr;
};

}  // namespace touchline
