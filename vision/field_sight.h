// SPDX-License-Identifier: Apache-2.0
// What the picture shows along lines on the ground: the measure by which candidates for junctions are judged. All
// lengths that decide are the larger of line widths and working pixels: near the robot the field limits, far away the
// picture.
#pragma once

#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline {

inline float ground_distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }
/// The angle between two lines of these directions, 0..pi/2.
inline float line_angle(const GroundPoint& a, const GroundPoint& b) {
  return math::atan2(math::abs(a.x * b.y - a.y * b.x), math::abs(a.x * b.x + a.y * b.y));
}
/// Distance of a point from a segment's line, > 0 to its left.
inline float distance_across(const LineSegment& s, const GroundPoint& p) {
  return s.direction.x * (p.y - s.end[0].y) - s.direction.y * (p.x - s.end[0].x);
}

inline constexpr float white_enough = 0.8F;  // part of a way that is on a line, when a line goes there
inline constexpr float dark_enough = 0.5F;   // and when none does

/// Parts of a way on the ground.
struct Sight {
  float white = 0.0F;   // on a line, or beside one by a pixel
  float middle = 0.0F;  // on a line
  float carpet = 0.0F;  // on carpet or on a line
  float inside = 0.0F;  // in the picture, from its beginning on
  bool seen = true;     // all of it lies in the picture and in the region of interest
};

/// A direction on the ground with its unit vector, worked out once for many points.
struct Heading {
  explicit Heading(float direction) : angle(direction) {
    const auto [s, c] = math::sin_cos(direction);
    out = {c, s};
  }
  float angle;  // robot's frame, radians
  GroundPoint out;
};

/// For what is told by the longest or the shortest pixel at a place and not by that in a direction: more than rounding.
inline constexpr float pixel_slack = 1.0e-3F;

/// What a working pixel means on the ground at a point.
class GroundPixel {
 public:
  GroundPixel() = default;
  GroundPixel(const WorkRays& rays, const GroundPoint& p);
  /// Metres in a direction.
  [[nodiscard]] float along(const Heading& heading) const {
    if (!(range_ > 1.0e-3F)) return across_;
    const float c = (x_ * heading.out.x + y_ * heading.out.y) / range_;
    return math::sqrt(math::square(towards_ * c) + math::square(across_) * (1.0F - c * c));
  }
  /// Metres in the worst one, away from the camera, and in the best.
  [[nodiscard]] float longest() const { return towards_; }
  [[nodiscard]] float shortest() const { return across_; }

 private:
  float x_ = 0.0F, y_ = 0.0F, range_ = 0.0F;  // of the point, from the camera's foot
  float across_ = 0.0F, towards_ = 0.0F;
};

class FieldSight {
 public:
  /// All arguments must outlive this.
  FieldSight(const WorkRays& rays, const FieldView& field, float line_width_m)
      : rays_(rays), field_(field), line_width_(line_width_m) {}

  /// Metres on the ground of a working pixel, in a direction.
  [[nodiscard]] float metres_per_px(const GroundPoint& p, const Heading& heading) const {
    return GroundPixel(rays_, p).along(heading);
  }
  [[nodiscard]] float metres_per_px(const GroundPoint& p, float direction) const {
    return metres_per_px(p, Heading(direction));
  }
  /// A branch is a line when it goes on for longer than this; marks and spurs do not.
  [[nodiscard]] float min_branch(const GroundPoint& p, float direction) const {
    return min_branch(metres_per_px(p, direction));
  }
  /// Likewise, where a working pixel along the branch is `px` metres.
  [[nodiscard]] float min_branch(float px) const;
  /// What lies between two ground points, a sample a working pixel.
  [[nodiscard]] Sight look(const GroundPoint& from, const GroundPoint& to) const;
  /// Whether a stretch goes up to a point on its line: it covers it, or nearly, or the line is white in between.
  [[nodiscard]] bool reaches(const LineSegment& s, const GroundPoint& direction, const GroundPoint& at) const;
  /// How well a crossing on the line `a` is known, working pixels: `a` across itself, and `along` metres along it.
  [[nodiscard]] float place_sigma(const GroundPoint& p, const LineSegment& a, float along) const;
  /// Whether carpet is seen on both sides of a branch that leaves `p`, where a working pixel is `pixel`. A post or a
  /// foot on a line may look like one.
  [[nodiscard]] bool has_flanks(const GroundPoint& p, const GroundPixel& pixel, const Heading& heading,
                                float length) const;

 private:
  const WorkRays& rays_;
  const FieldView& field_;
  float line_width_;
};

}  // namespace touchline
