// SPDX-License-Identifier: Apache-2.0
#include "vision/work_rays.h"

namespace touchline {

WorkRays::WorkRays(const GroundProjection& projection, const RayGridView& grid, int frame_width, int frame_height,
                   int work_width, int work_height)
    : projection_(projection),
      grid_(grid),
      robot_from_camera_(robot_from_camera(projection.pose())),
      per_work_u_(static_cast<float>(frame_width) / static_cast<float>(work_width)),
      per_work_v_(static_cast<float>(frame_height) / static_cast<float>(work_height)),
      radians_per_pixel_(0.5F * (per_work_u_ + per_work_v_) / projection.lens().parameters().focal_px),
      work_width_(work_width),
      work_height_(work_height) {}

bool WorkRays::ray(const WorkPoint& p, Vec3& ray) const {
  constexpr float cell = static_cast<float>(ray_cell_px);
  if (!(p.u >= 0.0F && p.v >= 0.0F)) return false;
  const int column = static_cast<int>(p.u / cell);
  const int row = static_cast<int>(p.v / cell);
  if (column + 1 >= grid_.columns || row + 1 >= grid_.rows) return false;
  const float fu = p.u / cell - static_cast<float>(column);
  const float fv = p.v / cell - static_cast<float>(row);
  Vec3 sum;
  for (int i = 0; i < 4; ++i) {
    const Vec3& corner = grid_.at(column + i % 2, row + i / 2);
    if (dot(corner, corner) < 0.5F) return false;  // the lens has no ray there
    const float weight = (i % 2 == 1 ? fu : 1.0F - fu) * (i / 2 == 1 ? fv : 1.0F - fv);
    sum.x += weight * corner.x;
    sum.y += weight * corner.y;
    sum.z += weight * corner.z;
  }
  ray = multiply(robot_from_camera_, sum);
  return true;
}

bool WorkRays::work_point(const GroundPoint& p, float z, WorkPoint& work) const {
  PixelPoint pixel;
  if (!projection_.pixel(p, z, pixel)) return false;
  work = {pixel.u / per_work_u_, pixel.v / per_work_v_};
  return true;
}

}  // namespace touchline
