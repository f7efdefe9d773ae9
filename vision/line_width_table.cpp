// SPDX-License-Identifier: Apache-2.0
#include "vision/line_width_table.h"

#include <cassert>

#include "platform/core/elementary.h"

namespace touchline {
namespace {

bool has_ray(const Vec3& ray) { return dot(ray, ray) > 0.0F; }

Vec3 combine(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, float fa, float fb, float fc, float fd) {
  return {fa * a.x + fb * b.x + fc * c.x + fd * d.x, fa * a.y + fb * b.y + fc * c.y + fd * d.y,
          fa * a.z + fb * b.z + fc * c.z + fd * d.z};
}

/// How the ground point moves when the ray does: ground = height * (x, y) / -z, by the quotient rule.
GroundPoint ground_step(const Vec3& ray, const Vec3& step, float height) {
  const float factor = height / (ray.z * ray.z);
  return {factor * (ray.x * step.z - step.x * ray.z), factor * (ray.y * step.z - step.y * ray.z)};
}

float length(float x, float y) { return math::hypot(x, y); }

std::uint16_t quantised(float working_px) {
  const float sixteenths = working_px * 16.0F + 0.5F;
  return sixteenths < 65535.0F ? static_cast<std::uint16_t>(sixteenths) : std::uint16_t{65535};  // NaN: the most
}

LineWidth width_of_block(const Vec3 corner[4], const Mat3& rotation, float height, float line_width_m) {
  constexpr float cell = static_cast<float>(ray_cell_px);
  const Vec3& a = corner[0];
  const Vec3& b = corner[1];
  const Vec3& c = corner[2];
  const Vec3& d = corner[3];
  const Vec3 ray = multiply(rotation, combine(a, b, c, d, 0.25F, 0.25F, 0.25F, 0.25F));
  constexpr float least_steepness = 0.02F;  // 50 camera heights away
  if (ray.z > -least_steepness) return {};
  constexpr float half = 0.5F / cell;
  const GroundPoint u = ground_step(ray, multiply(rotation, combine(a, b, c, d, -half, half, -half, half)), height);
  const GroundPoint v = ground_step(ray, multiply(rotation, combine(a, b, c, d, -half, -half, half, half)), height);
  const float area = math::abs(u.x * v.y - u.y * v.x);  // |det J|
  if (!(area > 0.0F)) return {};
  const float scale = line_width_m / area;
  return {quantised(scale * length(v.x, v.y)), quantised(scale * length(u.x, u.y)),
          quantised(scale * math::max(length(u.x + v.x, u.y + v.y), length(u.x - v.x, u.y - v.y)))};
}

}  // namespace

void make_line_width_table(const RayGridView& grid, const CameraPose& pose, float line_width_m,
                           ImageView<LineWidth> table) {
  assert(table.width + 1 == grid.columns && table.height + 1 == grid.rows);
  const Mat3 rotation = robot_from_camera(pose);
  for (int row = 0; row < table.height; ++row) {
    for (int column = 0; column < table.width; ++column) {
      const Vec3 corner[4] = {grid.at(column, row), grid.at(column + 1, row), grid.at(column, row + 1),
                              grid.at(column + 1, row + 1)};
      const bool seen = has_ray(corner[0]) && has_ray(corner[1]) && has_ray(corner[2]) && has_ray(corner[3]);
      table.at(column, row) = seen ? width_of_block(corner, rotation, pose.height, line_width_m) : LineWidth{};
    }
  }
}

}  // namespace touchline
