// SPDX-License-Identifier: Apache-2.0
// From working pixels to rays in the robot's axes and to the ground, for one frame: the lens's ray grid, interpolated
// and turned by the frame's attitude. Ten times cheaper than asking the lens for every pixel of a skeleton.
#pragma once

#include "vision/lens/camera_pose.h"
#include "vision/ray_grid.h"

namespace touchline {

inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// A ray and how it turns: both in the robot's axes, per working pixel along u and along v.
struct RayPatch {
  Vec3 ray, by_u, by_v;
};

class WorkRays {
 public:
  /// `projection` must outlive this. `grid` was made for its lens.
  WorkRays(const GroundProjection& projection, const RayGridView& grid, int frame_width, int frame_height,
           int work_width, int work_height);

  /// Ray (unit to 0.1 %) of a working point; false outside the lens.
  [[nodiscard]] bool ray(const WorkPoint& p, Vec3& ray) const;
  /// The same with its derivatives, which are those between the corners of the grid around.
  [[nodiscard]] bool patch(const WorkPoint& p, RayPatch& patch) const;
  /// Where a ground point lies in the working image; false outside the lens (it may lie outside the image).
  [[nodiscard]] bool work_point(const GroundPoint& p, float z, WorkPoint& work) const;
  /// work_point() of many points on the carpet, bit for bit; GroundProjection::pixels() with working pixels.
  void work_points(RayLanes& points) const;
  [[nodiscard]] PixelPoint camera_pixel(const WorkPoint& p) const { return {p.u * per_work_u_, p.v * per_work_v_}; }

  [[nodiscard]] const GroundProjection& projection() const { return projection_; }
  /// Angle that a working pixel means on the optical axis, mean of both directions.
  [[nodiscard]] float radians_per_pixel() const { return radians_per_pixel_; }
  [[nodiscard]] const RayGridView& grid() const { return grid_; }
  [[nodiscard]] const Mat3& robot_from_camera() const { return robot_from_camera_; }
  [[nodiscard]] int work_width() const { return work_width_; }
  [[nodiscard]] int work_height() const { return work_height_; }

 private:
  struct Cell {
    const Vec3 *upper = nullptr, *lower = nullptr;  // the left corners; the right ones follow
    float u = 0.0F, v = 0.0F;                       // [0, 1) inside the cell
  };
  [[nodiscard]] bool find_cell(const WorkPoint& p, Cell& cell) const;

  const GroundProjection& projection_;
  RayGridView grid_;
  Mat3 robot_from_camera_;
  float per_work_u_;  // camera pixels a working pixel
  float per_work_v_;
  float radians_per_pixel_;
  int work_width_;
  int work_height_;
};

}  // namespace touchline
