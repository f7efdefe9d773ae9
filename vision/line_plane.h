// SPDX-License-Identifier: Apache-2.0
// Lines as planes through the camera: the fit, what follows from it on the ground, and the joining of what is one line.
#pragma once

#include "vision/line_segments.h"

namespace touchline {

/// Sums for a plane through the camera near that of two rays: its normal is n0 + a * along + b * towards.
class PlaneFit {
 public:
  PlaneFit(const Vec3& r0, const Vec3& r1)
      : n0_(normalized(cross(r0, r1))),
        along_(normalized({r1.x - r0.x, r1.y - r0.y, r1.z - r0.z})),
        towards_(cross(n0_, along_)) {}
  void add(const Vec3& r) {
    const float x = dot(r, along_);
    const float y = dot(r, n0_);
    const float z = dot(r, towards_);
    xx_ += x * x;
    xz_ += x * z;
    zz_ += z * z;
    xy_ += x * y;
    zy_ += z * y;
  }
  /// The normal for which the sum of squared distances is least; false when the rays span no plane.
  [[nodiscard]] bool solve(Vec3& normal) const {
    const float det = xx_ * zz_ - xz_ * xz_;
    if (!(det > 1.0e-9F)) return false;
    const float a = (-xy_ * zz_ + zy_ * xz_) / det;
    const float b = (-zy_ * xx_ + xy_ * xz_) / det;
    normal = normalized({n0_.x + a * along_.x + b * towards_.x, n0_.y + a * along_.y + b * towards_.y,
                         n0_.z + a * along_.z + b * towards_.z});
    return true;
  }

 private:
  Vec3 n0_, along_, towards_;
  float xx_ = 0.0F, xz_ = 0.0F, zz_ = 0.0F, xy_ = 0.0F, zy_ = 0.0F;
};

// A skeleton point lies within half a pixel of where thinning sees the middle, and thinning within half a pixel of it.
inline constexpr float line_tolerance_px = 1.2F;
// The edges of a wide line are ragged by texture and light; its middle moves by a part of the width.
inline constexpr float line_tolerance_widths = 0.12F;

/// How far a skeleton point may lie off its line, as an angle, seen from `depth` metres.
inline float line_tolerance(const WorkRays& rays, float line_width_m, float depth) {
  return line_tolerance_px * rays.radians_per_pixel() + line_tolerance_widths * line_width_m / depth;
}
/// Its least, at any depth.
inline float least_line_tolerance(const WorkRays& rays) { return line_tolerance_px * rays.radians_per_pixel(); }

/// What follows from segment.normal and the rays near its ends; false when it is too short or not on the ground.
bool measure_segment(const WorkRays& rays, float line_width_m, const Vec3& first, const Vec3& last,
                     LineSegment& segment);

/// One line of the field, broken by a fork, a foot or a post, becomes one segment again.
void join_segments(const WorkRays& rays, const FieldView& field, float line_width_m, LineSegments& lines);

}  // namespace touchline
