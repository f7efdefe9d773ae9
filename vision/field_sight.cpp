// SPDX-License-Identifier: Apache-2.0
#include "vision/field_sight.h"

namespace touchline {
namespace {

constexpr float branch_widths = 2.2F;
constexpr float branch_px = 3.5F;
// A stretch ends where thinning bends the skeleton toward a fork. From there to the crossing the line has to be white.
constexpr float max_gap_px = 25.0F;
constexpr float max_gap_widths = 6.0F;
constexpr float near_px = 3.0F;
constexpr float near_widths = 0.5F;
constexpr float line_px = 0.4F;  // 1 sigma of a line across, at its middle
constexpr float line_widths = 0.1F;
constexpr float flank_px = 1.5F;
constexpr int flank_samples = 6;

}  // namespace

GroundPixel::GroundPixel(const WorkRays& rays, const GroundPoint& p) {
  const CameraPose& pose = rays.projection().pose();
  x_ = p.x - pose.x;
  y_ = p.y - pose.y;
  range_ = math::hypot(x_, y_);
  const float depth = math::hypot(range_, pose.height);
  across_ = depth * rays.radians_per_pixel();
  towards_ = across_ * depth / pose.height;
}

float FieldSight::min_branch(float px) const { return math::max(branch_widths * line_width_, branch_px * px); }

Sight FieldSight::look(const GroundPoint& from, const GroundPoint& to) const {
  Sight sight;
  RayLanes ends;
  ends.add(from);
  ends.add(to);
  rays_.work_points(ends);
  if (ends.seen[0] + ends.seen[1] < 2) return {0.0F, 0.0F, 0.0F, 0.0F, false};
  const WorkPoint a{ends.u[0], ends.v[0]};
  const WorkPoint b{ends.u[1], ends.v[1]};
  const float apart = math::max(math::abs(b.u - a.u), math::abs(b.v - a.v));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 2.0F, 64.0F));
  int white = 0, middle = 0, carpet = 0, inside = 0;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const float u = a.u + t * (b.u - a.u);
    const float v = a.v + t * (b.v - a.v);
    const int x = static_cast<int>(u);
    const int y = static_cast<int>(v);
    if (!(u >= 0.0F && v >= 0.0F) || x >= rays_.work_width() || y >= rays_.work_height()) {
      sight.seen = false;  // it leaves the picture: what comes after counts as nothing
      break;
    }
    ++inside;
    if (field_.roi.words != nullptr && !field_.roi.get(x, y)) sight.seen = false;
    // The mask of a thin line may lie a pixel beside its middle.
    const bool strict = field_.lines.get(x, y);
    const bool line = strict || field_.lines.get(x - 1, y) || field_.lines.get(x + 1, y) ||
                      field_.lines.get(x, y - 1) || field_.lines.get(x, y + 1);
    white += line ? 1 : 0;
    middle += strict ? 1 : 0;
    carpet += strict || field_.green.get(x, y) ? 1 : 0;
  }
  const float all = static_cast<float>(steps + 1);
  sight.white = static_cast<float>(white) / all;
  sight.inside = static_cast<float>(inside) / all;
  sight.middle = static_cast<float>(middle) / all;
  sight.carpet = static_cast<float>(carpet) / all;
  return sight;
}

bool FieldSight::reaches(const LineSegment& s, const GroundPoint& direction, const GroundPoint& at) const {
  const float before = (s.end[0].x - at.x) * direction.x + (s.end[0].y - at.y) * direction.y;
  const float after = (s.end[1].x - at.x) * direction.x + (s.end[1].y - at.y) * direction.y;
  if (before * after <= 0.0F) return true;
  const bool first = math::abs(before) < math::abs(after);
  const float gap = math::abs(first ? before : after);
  const GroundPixel pixel(rays_, at);
  const auto near = [&](float px) { return math::max(near_widths * line_width_, near_px * px); };
  const auto far = [&](float px) { return math::min(max_gap_px * px, max_gap_widths * line_width_ + near_px * px); };
  // The longest and the shortest pixel tell of most; only for the others the direction is worked out.
  if (gap > (1.0F + pixel_slack) * far(pixel.longest())) return false;
  if (gap < (1.0F - pixel_slack) * near(pixel.shortest())) return true;
  const bool between =
      gap > (1.0F + pixel_slack) * near(pixel.longest()) && gap < (1.0F - pixel_slack) * far(pixel.shortest());
  if (!between) {
    const float px = pixel.along(Heading(math::atan2(direction.y, direction.x)));
    if (gap <= near(px)) return true;
    if (gap > far(px)) return false;
  }
  return look(first ? s.end[0] : s.end[1], at).white >= white_enough;
}

float FieldSight::place_sigma(const GroundPoint& p, const LineSegment& a, float along) const {
  const GroundPoint middle{0.5F * (a.end[0].x + a.end[1].x), 0.5F * (a.end[0].y + a.end[1].y)};
  const float heading = math::atan2(a.direction.y, a.direction.x);
  const float rag = line_widths * line_width_;
  const GroundPixel pixel(rays_, p);
  const float off = math::hypot(a.sigma * ground_distance(middle, p), rag) /
                    pixel.along(Heading(wrap_angle(heading + math::half_pi)));
  const float ahead = math::hypot(along, rag) / pixel.along(Heading(heading));
  return math::sqrt(off * off + ahead * ahead + 2.0F * line_px * line_px);
}

bool FieldSight::has_flanks(const GroundPoint& from, const GroundPixel& pixel, const Heading& heading,
                            float length) const {
  const GroundPoint& out = heading.out;
  const float px = pixel.along(Heading(wrap_angle(heading.angle + math::half_pi)));
  const float aside = 0.75F * line_width_ + flank_px * px;
  for (const float side : {1.0F, -1.0F}) {
    int carpet = 0, other = 0;
    RayLanes samples;
    int taken = 0;
    for (int i = 0; i < flank_samples && 2 * carpet < flank_samples && 2 * other <= flank_samples; ++i) {
      if (i == taken) {  // half of them tell of most
        samples.count = 0;
        for (; 2 * (taken - i) < flank_samples && taken < flank_samples; ++taken) {
          const float d = length * (static_cast<float>(taken) + 1.0F) / static_cast<float>(flank_samples);
          samples.add({from.x + d * out.x - side * aside * out.y, from.y + d * out.y + side * aside * out.x});
        }
        rays_.work_points(samples);
      }
      const int k = i - taken + samples.count;
      const float u = samples.u[k];
      const float v = samples.v[k];
      if (samples.seen[k] == 0 || !(u >= 0.0F && v >= 0.0F)) continue;
      const int x = static_cast<int>(u);
      const int y = static_cast<int>(v);
      if (x >= rays_.work_width() || y >= rays_.work_height() || field_.lines.get(x, y)) continue;
      ++(field_.carpet.get(x, y) ? carpet : other);
    }
    if (other > carpet) return false;
  }
  return true;
}

}  // namespace touchline
