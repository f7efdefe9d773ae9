// SPDX-License-Identifier: Apache-2.0
#include "loc/visibility.h"

#include "loc/pose_view.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float spacing_m = 0.15F;
constexpr int max_samples_per_line = 100;  // 14 m at 0.15 m
constexpr int tolerance_px = 3;            // what the pose may be off in the picture (at 320 px width)

/// Farther than this beyond the range nothing has to be looked at point by point: no rounding reaches so far.
constexpr float slack_m = 0.01F;

struct Look {
  const VisionResult& vision;
  Pose2 pose;
  PoseView view;
  float max_range;
  int reach;
  Visibility out;
  RayLanes waiting;  // points on the ground whose pixels are not known yet: they are found side by side

  /// Carpet all around: the sample and its neighbours at the tolerance are green.
  [[nodiscard]] bool green_around(int x, int y) const {
    return vision.green.get(x, y) && vision.green.get(x - reach, y) && vision.green.get(x + reach, y) &&
           vision.green.get(x, y - reach) && vision.green.get(x, y + reach);
  }

  void sample(const FieldPoint& p) {
    const GroundPoint g = view.ground(p);
    if (g.x * g.x + g.y * g.y > max_range * max_range) return;
    waiting.add(g);
    if (waiting.count == RayLanes::most) look();
  }

  void look() {
    view.projection().pixels(waiting);
    for (int i = 0; i < waiting.count; ++i) {
      int x = 0;
      int y = 0;
      if (waiting.seen[i] == 0 || !view.working_pixel(PixelPoint{waiting.u[i], waiting.v[i]}, x, y)) continue;
      if (!vision.roi.get(x, y)) continue;
      if (view.line_near(x, y, reach)) {
        out.seen += spacing_m;
      } else if (green_around(x, y)) {
        out.missing += spacing_m;
      }
    }
    waiting.count = 0;
  }

  /// Does all between two corners, in each axis low to high, lie beyond the range?
  [[nodiscard]] bool beyond(const FieldPoint& low, const FieldPoint& high) const {
    const float x = pose.x - math::clamp(pose.x, low.x, high.x);
    const float y = pose.y - math::clamp(pose.y, low.y, high.y);
    return x * x + y * y > math::square(max_range + slack_m);
  }

  void segment(const FieldLine& line) {
    if (beyond({math::min(line.a.x, line.b.x), math::min(line.a.y, line.b.y)},
               {math::max(line.a.x, line.b.x), math::max(line.a.y, line.b.y)})) {
      return;
    }
    const float dx = line.b.x - line.a.x;
    const float dy = line.b.y - line.a.y;
    const float length = math::abs(dx) + math::abs(dy);  // parallel to an axis
    const int n = static_cast<int>(length / spacing_m);
    for (int i = 0; i < n && i < max_samples_per_line; ++i) {
      const float t = (static_cast<float>(i) + 0.5F) / static_cast<float>(n);
      sample({line.a.x + t * dx, line.a.y + t * dy});
    }
  }

  void circle(float radius) {
    if (beyond({-radius, -radius}, {radius, radius})) return;
    const int n = static_cast<int>(math::two_pi * radius / spacing_m);
    for (int i = 0; i < n && i < max_samples_per_line; ++i) {
      const float a = math::two_pi * static_cast<float>(i) / static_cast<float>(n);
      const auto [sine, cosine] = math::sin_cos(a);
      sample({radius * cosine, radius * sine});
    }
  }
};

}  // namespace

[[gnu::noinline]] Visibility check_visibility(const Field& field, const VisionResult& vision, const Refinement& refined,
                                              float max_range) {
  Look look{vision,
            refined.pose,
            PoseView(vision, refined.pose, refined.pitch_error, refined.roll_error),
            max_range,
            tolerance_px * vision.work_width / 320,
            {},
            {}};
  for (const FieldLine& line : field.lines()) look.segment(line);
  if (field.dimensions().circle_radius > 0.0F) look.circle(field.dimensions().circle_radius);
  look.look();
  return look.out;
}

}  // namespace touchline
