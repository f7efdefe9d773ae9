// SPDX-License-Identifier: Apache-2.0
#include "vision/ray_grid.h"

#include <array>
#include <cassert>
#include <cstdint>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

/// The same lens with a wider limit, for corners of blocks that the image circle cuts; the lens itself where its
/// formula ends.
Lens beyond_the_circle(const Lens& lens) {
  LensParameters parameters = lens.parameters();
  for (const float more : {0.15F, 0.05F}) {
    parameters.max_theta = lens.parameters().max_theta + more;
    Lens wider;
    if (Lens::create(parameters, wider) == Status::ok) return wider;
  }
  return lens;
}

void clear_polygon(const MaskPolygon& polygon, float scale_u, float scale_v, BitView seen) {
  std::array<SubpixelPoint, max_mask_polygon_points> points{};
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    points[i] = {static_cast<std::int32_t>(polygon[i].u / scale_u * static_cast<float>(subpixels)),
                 static_cast<std::int32_t>(polygon[i].v / scale_v * static_cast<float>(subpixels))};
  }
  static_assert(max_mask_polygon_points <= max_polygon_points, "no point of a body mask is left out");
  [[maybe_unused]] const std::size_t left_out = fill_polygon(seen, {points.data(), polygon.size()}, false);
  assert(left_out == 0);
}

}  // namespace

void read_row(const RayGridView& grid, int row, RayRow& out) {
  const Vec3* rays = &grid.at(0, row);
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (std::size_t i = 0; i < columns; ++i) {
    out.x[i] = rays[i].x;
    out.y[i] = rays[i].y;
    out.z[i] = rays[i].z;
  }
}

void make_ray_grid(const Lens& lens, int frame_width, int frame_height, int work_width, int work_height,
                   RayGridView grid) {
  assert(grid.columns == ray_columns(work_width) && grid.rows == ray_rows(work_height));
  const Lens wider = beyond_the_circle(lens);
  const float scale_u = static_cast<float>(frame_width) / static_cast<float>(work_width);
  const float scale_v = static_cast<float>(frame_height) / static_cast<float>(work_height);
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      Vec3 ray;
      const PixelPoint pixel{static_cast<float>(column * ray_cell_px) * scale_u,
                             static_cast<float>(row * ray_cell_px) * scale_v};
      grid.at(column, row) = wider.ray(pixel, ray) ? ray : Vec3{};
    }
  }
}

void make_seen_mask(const Lens& lens, int frame_width, int frame_height, std::span<const MaskPolygon> body,
                    BitView seen) {
  const float scale_u = static_cast<float>(frame_width) / static_cast<float>(seen.width);
  const float scale_v = static_cast<float>(frame_height) / static_cast<float>(seen.height);
  clear(seen);
  for (int y = 0; y < seen.height; ++y) {
    for (int x = 0; x < seen.width; ++x) {
      Vec3 ray;
      const PixelPoint pixel{(static_cast<float>(x) + 0.5F) * scale_u, (static_cast<float>(y) + 0.5F) * scale_v};
      if (lens.ray(pixel, ray)) seen.set(x, y, true);
    }
  }
  for (const MaskPolygon& polygon : body) clear_polygon(polygon, scale_u, scale_v, seen);
}

}  // namespace touchline
