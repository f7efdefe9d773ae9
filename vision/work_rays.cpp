// SPDX-License-Identifier: Apache-2.0
#include "vision/work_rays.h"

namespace touchline {

WorkRays::WorkRays(const GroundProjection& projection, const RayGridView& grid, int frame_width, int frame_height,
                   int work_width, int work_height)
    : projection_(projection),
      grid_(grid),
      robot_from_camera_(touchline::robot_from_camera(projection.pose())),
      per_work_u_(static_cast<float>(frame_width) / static_cast<float>(work_width)),
      per_work_v_(static_cast<float>(frame_height) / static_cast<float>(work_height)),
      radians_per_pixel_(0.5F * (per_work_u_ + per_work_v_) / projection.lens().parameters().focal_px),
      work_width_(work_width),
      work_height_(work_height) {}

bool WorkRays::find_cell(const WorkPoint& p, Cell& cell) const {
  constexpr float cells_a_px = 1.0F / static_cast<float>(ray_cell_px);
  if (!(p.u >= 0.0F && p.v >= 0.0F)) return false;
  const float u = p.u * cells_a_px;
  const float v = p.v * cells_a_px;
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  if (column + 1 >= grid_.columns || row + 1 >= grid_.rows) return false;
  cell = {&grid_.at(column, row), &grid_.at(column, row + 1), u - static_cast<float>(column),
          v - static_cast<float>(row)};
  const auto seen = [](const Vec3& corner) { return dot(corner, corner) >= 0.5F; };  // the lens has a ray there
  return seen(cell.upper[0]) && seen(cell.upper[1]) && seen(cell.lower[0]) && seen(cell.lower[1]);
}

bool WorkRays::ray(const WorkPoint& p, Vec3& ray) const {
  Cell cell;
  if (!find_cell(p, cell)) return false;
  const float weights[4] = {(1.0F - cell.u) * (1.0F - cell.v), cell.u * (1.0F - cell.v), (1.0F - cell.u) * cell.v,
                            cell.u * cell.v};
  const Vec3* corners[4] = {cell.upper, cell.upper + 1, cell.lower, cell.lower + 1};
  Vec3 sum;
  for (int i = 0; i < 4; ++i) {
    sum.x += weights[i] * corners[i]->x;
    sum.y += weights[i] * corners[i]->y;
    sum.z += weights[i] * corners[i]->z;
  }
  ray = multiply(robot_from_camera_, sum);
  return true;
}

bool WorkRays::patch(const WorkPoint& p, RayPatch& patch) const {
  Cell cell;
  if (!find_cell(p, cell)) return false;
  const auto mix = [](const Vec3& a, const Vec3& b, float share) {
    return Vec3{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
  };
  const auto slope = [](const Vec3& a, const Vec3& b) {
    constexpr float cells_a_px = 1.0F / static_cast<float>(ray_cell_px);
    return Vec3{cells_a_px * (b.x - a.x), cells_a_px * (b.y - a.y), cells_a_px * (b.z - a.z)};
  };
  const Vec3 upper = mix(cell.upper[0], cell.upper[1], cell.u);
  const Vec3 lower = mix(cell.lower[0], cell.lower[1], cell.u);
  const Vec3 left = mix(cell.upper[0], cell.lower[0], cell.v);
  const Vec3 right = mix(cell.upper[1], cell.lower[1], cell.v);
  patch.ray = multiply(robot_from_camera_, mix(upper, lower, cell.v));
  patch.by_u = multiply(robot_from_camera_, slope(left, right));
  patch.by_v = multiply(robot_from_camera_, slope(upper, lower));
  return true;
}

bool WorkRays::work_point(const GroundPoint& p, float z, WorkPoint& work) const {
  PixelPoint pixel;
  if (!projection_.pixel(p, z, pixel)) return false;
  work = {pixel.u / per_work_u_, pixel.v / per_work_v_};
  return true;
}

void WorkRays::work_points(RayLanes& points) const {
  projection_.pixels(points);
  const int count = points.padded();
  for (int i = 0; i < count; ++i) {
    points.u[i] /= per_work_u_;
    points.v[i] /= per_work_v_;
  }
}

}  // namespace touchline
