// SPDX-License-Identifier: Apache-2.0
// A row of blocks at a time, by loops that vectorise. Of a block's four corner rays the sum is four times the ray of
// its centre, and the differences of sums are 16 times the steps to the next pixel: powers of two, which the last
// multiplication takes out again without rounding.
#include "vision/line_width_table.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "platform/core/elementary.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {

constexpr std::size_t max_blocks = RayRow::capacity - 1;
using Flags = std::array<std::int32_t, max_blocks>;
static_assert(ray_cell_px == 8, "the factors below");

/// Corners of block i: a b above, c d below.
struct Component {
  float a, b, c, d;
  Component(const std::array<float, RayRow::capacity>& above, const std::array<float, RayRow::capacity>& below,
            std::size_t i)
      : a(above[i]), b(above[i + 1]), c(below[i]), d(below[i + 1]) {}
  [[nodiscard]] float centre() const { return a + b + c + d; }          // 4 times
  [[nodiscard]] float along_row() const { return b - a - c + d; }       // 16 times the step
  [[nodiscard]] float along_column() const { return c - (a + b) + d; }  // likewise
};

std::int32_t has_ray(const RayRow& row, std::size_t i) {
  return row.x[i] * row.x[i] + row.y[i] * row.y[i] + row.z[i] * row.z[i] > 0.0F ? 1 : 0;
}

/// Which blocks have ground, or could.
void find_ground(const RayRow& above, const RayRow& below, const Mat3& rotation, std::size_t blocks, Flags& ground) {
  constexpr float least_steepness = 0.02F;  // 50 camera heights away
  const float* m = rotation.m[2];
  for (std::size_t i = 0; i < blocks; ++i) {
    const float z = m[0] * Component(above.x, below.x, i).centre() + m[1] * Component(above.y, below.y, i).centre() +
                    m[2] * Component(above.z, below.z, i).centre();
    const std::int32_t seen = has_ray(above, i) & has_ray(above, i + 1) & has_ray(below, i) & has_ray(below, i + 1);
    ground[i] = seen & (z > -4.0F * least_steepness ? 0 : 1);
  }
}

/// Of a row of blocks, in sixteenths of a pixel.
struct Extents {
  std::array<std::int32_t, max_blocks> across_row, across_column, slanted;
};

std::int32_t rounded(float sixteenths) {
  const float x = sixteenths + 0.5F;
  return static_cast<std::int32_t>(x < 65535.0F ? x : 65535.0F);  // NaN: the most
}

/// Rays and steps are turned into the robot's frame; how the ground point moves when the ray does follows from
/// ground = height * (x, y) / -z by the quotient rule: here 4 times the steps u and v, 16 times the area |det J|.
void measure_block(const RayRow& above, const RayRow& below, std::size_t i, const Mat3& rotation, float height,
                   float line_width_m, Extents& extents, Flags& ground) {
  const Component x(above.x, below.x, i);
  const Component y(above.y, below.y, i);
  const Component z(above.z, below.z, i);
  const auto turned = [&rotation](float a, float b, float c) {
    const auto& m = rotation.m;
    return Vec3{m[0][0] * a + m[0][1] * b + m[0][2] * c, m[1][0] * a + m[1][1] * b + m[1][2] * c,
                m[2][0] * a + m[2][1] * b + m[2][2] * c};
  };
  const Vec3 ray = turned(x.centre(), y.centre(), z.centre());
  const Vec3 right = turned(x.along_row(), y.along_row(), z.along_row());
  const Vec3 down = turned(x.along_column(), y.along_column(), z.along_column());
  const float factor = height / (ray.z * ray.z);
  const float ux = factor * (ray.x * right.z - right.x * ray.z);
  const float uy = factor * (ray.y * right.z - right.y * ray.z);
  const float vx = factor * (ray.x * down.z - down.x * ray.z);
  const float vy = factor * (ray.y * down.z - down.y * ray.z);
  const float area = math::abs(ux * vy - uy * vx);
  const float scale = line_width_m / area;
  ground[i] &= area > 0.0F ? 1 : 0;
  extents.across_row[i] = rounded(scale * math::hypot(vx, vy) * 64.0F);
  extents.across_column[i] = rounded(scale * math::hypot(ux, uy) * 64.0F);
  const float falling = math::hypot(ux + vx, uy + vy);
  const float rising = math::hypot(ux - vx, uy - vy);
  extents.slanted[i] = rounded(scale * math::max(falling, rising) * 64.0F);
}

LineWidth width_of(const Extents& extents, std::size_t i) {
  return {static_cast<std::uint16_t>(extents.across_row[i]), static_cast<std::uint16_t>(extents.across_column[i]),
          static_cast<std::uint16_t>(extents.slanted[i])};
}

}  // namespace

void make_line_width_table(const RayGridView& grid, const CameraPose& pose, float line_width_m,
                           ImageView<LineWidth> table) {
  assert(table.width + 1 == grid.columns && table.height + 1 == grid.rows);
  const Mat3 rotation = robot_from_camera(pose);
  const auto blocks = static_cast<std::size_t>(table.width);
  std::array<RayRow, 2> rows;
  Flags ground;
  Extents extents;
  read_row(grid, 0, rows[0]);
  for (int row = 0; row < table.height; ++row) {
    const RayRow& above = rows[static_cast<std::size_t>(row % 2)];
    RayRow& below = rows[static_cast<std::size_t>((row + 1) % 2)];
    read_row(grid, row + 1, below);
    find_ground(above, below, rotation, blocks, ground);
    const auto first = std::find(ground.begin(), ground.begin() + table.width, 1) - ground.begin();
    for (std::size_t i = static_cast<std::size_t>(first); i < blocks; ++i) {
      if constexpr (!vector_registers) {
        if (ground[i] == 0) continue;
      }
      measure_block(above, below, i, rotation, pose.height, line_width_m, extents, ground);
    }
    LineWidth* out = table.row(row);
    for (std::size_t i = 0; i < blocks; ++i) {
      out[i] = ground[i] == 0 ? LineWidth{} : width_of(extents, i);
    }
  }
}

}  // namespace touchline
