// SPDX-License-Identifier: Apache-2.0
// The rays of working pixels, for many pixels beside each other: the same as WorkRays::ray() of their centres, bit for
// bit, but the cell of the ray grid is looked up and checked once for all pixels in it.
#pragma once

#include "vision/image/grid_point.h"
#include "vision/work_rays.h"

namespace touchline {

class PixelRays {
 public:
  /// `rays` outlives this.
  explicit PixelRays(const WorkRays& rays) : rays_(rays) {
    const Mat3& turn = rays.robot_from_camera();
    for (int i = 0; i < 3; ++i) axes_[i] = Lanes{turn.m[0][i], turn.m[1][i], turn.m[2][i], 0.0F};
  }

  /// The ray of the pixel's centre, robot's axes, unit to 0.1 %; false outside the lens. `p` lies in the image.
  [[nodiscard]] bool ray(GridPoint p, Vec3& ray) {
    const auto x = static_cast<unsigned>(p.x);
    const auto y = static_cast<unsigned>(p.y);
    const int column = static_cast<int>(x / ray_cell_px);
    const int row = static_cast<int>(y / ray_cell_px);
    if (column != column_ || row != row_) enter(column, row);
    if (!seen_) return false;
    const float u = offset(x);
    const float v = offset(y);
    const float weights[4] = {(1.0F - u) * (1.0F - v), u * (1.0F - v), (1.0F - u) * v, u * v};
    Lanes sum{};
    for (int i = 0; i < 4; ++i) sum += weights[i] * corners_[i];
    const Lanes turned = axes_[0] * sum[0] + axes_[1] * sum[1] + axes_[2] * sum[2];
    ray = {turned[0], turned[1], turned[2]};
    return true;
  }

 private:
  using Lanes = float __attribute__((vector_size(16)));  // x, y, z and nothing: what a vector register holds
  /// Where a pixel's centre lies in its cell, in parts of it.
  static float offset(unsigned x) {
    return (static_cast<float>(static_cast<int>(x % ray_cell_px)) + 0.5F) * (1.0F / static_cast<float>(ray_cell_px));
  }
  void enter(int column, int row) {
    column_ = column;
    row_ = row;
    seen_ = true;
    for (int i = 0; i < 4; ++i) {
      const Vec3& corner = rays_.grid().at(column + i % 2, row + i / 2);
      seen_ = seen_ && dot(corner, corner) >= 0.5F;  // the lens has a ray there
      corners_[i] = Lanes{corner.x, corner.y, corner.z, 0.0F};
    }
  }

  const WorkRays& rays_;
  int column_ = -1;
  int row_ = -1;
  bool seen_ = false;
  Lanes axes_[3]{};  // the columns of the rotation
  Lanes corners_[4]{};
};

}  // namespace touchline
