// SPDX-License-Identifier: Apache-2.0
// The lens on a coarse grid: one ray for every corner of the 8x8 blocks of the working image. Made once for a lens; a
// frame's attitude only turns it. Between the corners rays are smooth enough to be interpolated (off by less than 0.1
// working pixel).
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "platform/core/geometry.h"
#include "vision/image/bit_image.h"
#include "vision/image/morphology.h"
#include "vision/lens/lens.h"
#include "vision/vision_config.h"

namespace touchline {

inline constexpr int ray_cell_px = 8;
constexpr int ray_columns(int work_width) { return (work_width + ray_cell_px - 1) / ray_cell_px + 1; }
constexpr int ray_rows(int work_height) { return (work_height + ray_cell_px - 1) / ray_cell_px + 1; }

/// Camera's optical axes, unit vectors, row by row; the zero vector where the lens has no ray.
struct RayGridView {
  std::span<Vec3> rays;  // columns x rows
  int columns = 0;
  int rows = 0;

  [[nodiscard]] Vec3& at(int column, int row) const {
    return rays[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

/// One row of the grid, a component after the other: for loops over its columns that vectorise.
struct RayRow {
  static constexpr std::size_t capacity = static_cast<std::size_t>(ray_columns(max_mask_width));
  std::array<float, capacity> x, y, z;
};
void read_row(const RayGridView& grid, int row, RayRow& out);

/// Fills the grid. Corners a little outside the image circle get a ray too where the lens's formula allows it, so that
/// blocks on the circle can be interpolated.
void make_ray_grid(const Lens& lens, int frame_width, int frame_height, int work_width, int work_height,
                   RayGridView grid);

/// Sets the working pixels whose centre lies inside the lens's image circle and outside the polygons of `body` (camera
/// pixels).
void make_seen_mask(const Lens& lens, int frame_width, int frame_height, std::span<const MaskPolygon> body,
                    BitView seen);

}  // namespace touchline
