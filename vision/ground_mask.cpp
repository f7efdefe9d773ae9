// SPDX-License-Identifier: Apache-2.0
#include "vision/ground_mask.h"

#include <array>
#include <cstdint>

#include "platform/core/elementary.h"
#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

constexpr float steepness_scale = 16384.0F;  // 2^14: a sine fits int16 with room
constexpr std::int32_t no_ray = -32768;

using CornerRow = std::array<std::int32_t, static_cast<std::size_t>(ray_columns(max_mask_width))>;

/// How steeply the rays of one grid row look down: minus the sine of their elevation, in 2^-14.
void steepness_of_row(const RayGridView& grid, int row, const Vec3& up, CornerRow& out) {
  for (int i = 0; i < grid.columns; ++i) {
    const Vec3& ray = grid.at(i, row);
    const bool any = dot(ray, ray) > 0.0F;
    out[static_cast<std::size_t>(i)] = any ? static_cast<std::int32_t>(-dot(ray, up) * steepness_scale) : no_ray;
  }
}

/// The cell right of corner `i`, a byte for each of its rows.
using CellRows = std::array<std::uint8_t, ray_cell_px>;
static_assert(ray_cell_px == 8);

CellRows cell_rows(const CornerRow& above, const CornerRow& below, std::size_t i, std::int32_t limit) {
  CellRows rows{};
  const std::int32_t corner[4] = {above[i], above[i + 1], below[i], below[i + 1]};
  int steep = 0;
  for (const std::int32_t c : corner) {
    if (c == no_ray) return rows;  // well outside the image circle
    steep += c > limit ? 1 : 0;
  }
  if (steep == 0) return rows;
  if (steep == 4) {
    rows.fill(0xFF);
    return rows;
  }
  for (int y = 0; y < ray_cell_px; ++y) {
    const std::int32_t down = 2 * y + 1;  // in half pixels, of 16
    const std::int32_t left = corner[0] * (16 - down) + corner[2] * down;
    const std::int32_t right = corner[1] * (16 - down) + corner[3] * down;
    unsigned bits = 0;
    for (int k = 0; k < ray_cell_px; ++k) {
      const std::int32_t across = 2 * k + 1;
      if (left * (16 - across) + right * across > limit * 256) bits |= 1U << k;
    }
    rows[static_cast<std::size_t>(y)] = static_cast<std::uint8_t>(bits);
  }
  return rows;
}

}  // namespace

void make_ground_mask(const RayGridView& grid, const CameraPose& pose, float max_range_m, ConstBitView seen,
                      BitView ground) {
  const Mat3 rotation = robot_from_camera(pose);
  const Vec3 up{rotation.m[2][0], rotation.m[2][1], rotation.m[2][2]};
  const auto limit = static_cast<std::int32_t>(pose.height / math::hypot(pose.height, max_range_m) * steepness_scale);
  CornerRow above{};
  CornerRow below{};
  steepness_of_row(grid, 0, up, below);
  clear(ground);
  for (int y0 = 0; y0 < ground.height; y0 += ray_cell_px) {
    above = below;
    steepness_of_row(grid, y0 / ray_cell_px + 1, up, below);
    const int rows = std::min(ray_cell_px, ground.height - y0);
    for (int i = 0; i + 1 < grid.columns; ++i) {
      const CellRows cell = cell_rows(above, below, static_cast<std::size_t>(i), limit);
      for (int y = 0; y < rows; ++y) {
        reinterpret_cast<unsigned char*>(ground.row(y0 + y))[i] = cell[static_cast<std::size_t>(y)];
      }
    }
  }
  and_with(ground, seen);
}

}  // namespace touchline
