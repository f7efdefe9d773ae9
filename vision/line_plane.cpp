// SPDX-License-Identifier: Apache-2.0
#include "vision/line_plane.h"

#include <algorithm>
#include <bit>

namespace touchline {
namespace {

// Thinning moves the ends of a stretch between two forks toward their sharp corners, and so turns short ones.
constexpr float short_widths = 5.0F;
constexpr float short_bend_widths = 0.7F;
constexpr float bend_widths = 0.25F;
// A fork, a foot or a post may lie between two parts of a line.
constexpr float max_join_gap_m = 0.5F;
constexpr float join_angle = radians(6.0F);
constexpr float max_join_angle = radians(30.0F);
constexpr float sin_max_join_angle = 0.5F;
constexpr float slack = 1.0001F;  // for what is told without a root or a sine: rounding makes no difference

float distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }

/// Whether bare carpet is seen between two points: then no line goes from one to the other.
bool carpet_between(const WorkRays& rays, const FieldView& field, const GroundPoint& a, const GroundPoint& b) {
  WorkPoint from, to;
  if (!rays.work_point(a, 0.0F, from) || !rays.work_point(b, 0.0F, to)) return false;
  const float apart = math::max(math::abs(to.u - from.u), math::abs(to.v - from.v));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 1.0F, 64.0F));
  int bare = 0;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const int x = static_cast<int>(from.u + t * (to.u - from.u));
    const int y = static_cast<int>(from.v + t * (to.v - from.v));
    bare += field.green.get(x, y) && !field.lines.get(x, y) ? 1 : 0;
  }
  return bare > 1 && 3 * bare > steps;
}

/// Whether two segments may be parts of one line, by their directions and by how far apart their ends are. Most pairs
/// are not, and which are is hard to foresee: no branches.
bool may_be_one(const LineSegment& a, const LineSegment& b) {
  const float turn = math::abs(a.direction.x * b.direction.y - a.direction.y * b.direction.x);
  const float most = slack * slack * math::square(a.length + b.length + max_join_gap_m);
  float farthest = 0.0F;
  for (const GroundPoint& p : a.end) {
    for (const GroundPoint& q : b.end) {
      farthest = math::max(farthest, math::square(p.x - q.x) + math::square(p.y - q.y));
    }
  }
  return (turn <= slack * sin_max_join_angle) & (farthest <= most);
}

/// Joins `b` to `a` when all four ends lie in one plane and the gap between is short.
bool join(const WorkRays& rays, const FieldView& field, float line_width_m, LineSegment& a, const LineSegment& b) {
  const float turn = math::abs(a.direction.x * b.direction.y - a.direction.y * b.direction.x);
  if (turn > math::sin(math::min(join_angle + a.sigma + b.sigma, max_join_angle))) return false;
  // The longest way between an end of one and an end of the other is the joined line.
  float longest = 0.0F;
  int far_a = 0, far_b = 0;
  for (int i = 0; i < 4; ++i) {
    const float d = distance(a.end[i / 2], b.end[i % 2]);
    if (d <= longest) continue;
    longest = d;
    far_a = i / 2;
    far_b = i % 2;
  }
  const float gap = longest - a.length - b.length;
  if (gap > max_join_gap_m || longest < math::max(a.length, b.length)) return false;
  const Vec3 outer[2] = {a.end_ray[far_a], b.end_ray[far_b]};
  PlaneFit plane(outer[0], outer[1]);
  LineSegment joined = a;
  const LineSegment* const parts[2] = {&a, &b};
  for (const LineSegment* s : parts) {
    for (const Vec3& r : s->end_ray) plane.add(r);
  }
  if (!plane.solve(joined.normal)) return false;
  for (const LineSegment* s : parts) {
    for (const Vec3& r : s->end_ray) {
      const float depth = rays.projection().pose().height / -r.z;
      if (math::abs(dot(joined.normal, r)) > line_tolerance(rays, line_width_m, depth)) return false;
    }
  }
  if (!measure_segment(rays, line_width_m, outer[0], outer[1], joined)) return false;
  if (gap > 0.0F && carpet_between(rays, field, a.end[1 - far_a], b.end[1 - far_b])) return false;
  joined.points = static_cast<std::uint16_t>(a.points + b.points);
  a = joined;
  return true;
}

}  // namespace

bool measure_segment(const WorkRays& rays, float line_width_m, const Vec3& first, const Vec3& last, LineSegment& s) {
  const Vec3 ends[2] = {first, last};
  for (int k = 0; k < 2; ++k) {
    const float off = dot(ends[k], s.normal);
    s.end_ray[k] =
        normalized({ends[k].x - off * s.normal.x, ends[k].y - off * s.normal.y, ends[k].z - off * s.normal.z});
    if (!rays.projection().intersect_ground(s.end_ray[k], s.end[k])) return false;
  }
  s.length = distance(s.end[0], s.end[1]);
  if (s.length < line_width_m) return false;
  s.direction = {(s.end[1].x - s.end[0].x) / s.length, (s.end[1].y - s.end[0].y) / s.length};
  const float epsilon = 0.5F * rays.radians_per_pixel();
  s.is_short = s.length < short_widths * line_width_m;
  float shift = math::square((s.is_short ? short_bend_widths : bend_widths) * line_width_m);
  for (const Vec3& r : s.end_ray) {  // how far the line moves on the ground when its plane turns by epsilon at this end
    const float reach = rays.projection().pose().height / -r.z;
    const float dx = reach * (s.normal.x - r.x / r.z * s.normal.z);
    const float dy = reach * (s.normal.y - r.y / r.z * s.normal.z);
    shift += math::square(epsilon * (dx * s.direction.y - dy * s.direction.x));
  }
  s.sigma = math::sqrt(shift) / s.length;
  return true;
}

void join_segments(const WorkRays& rays, const FieldView& field, float line_width_m, LineSegments& lines) {
  auto& segments = lines.segments;
  // Joins segment i with the first one that it can be joined with; that one's place is filled by the last.
  const auto grow = [&](std::size_t& i) {
    for (std::size_t first = 0; first < segments.size(); first += bits_per_word) {
      const std::size_t end = std::min(first + bits_per_word, segments.size());
      BitWord candidates = 0;
      for (std::size_t k = first; k < end; ++k) {
        candidates |= BitWord{may_be_one(segments[i], segments[k])} << (k - first);
      }
      for (; candidates != 0; candidates &= candidates - 1) {
        const std::size_t k = first + static_cast<std::size_t>(std::countr_zero(candidates));
        if (k == i || !join(rays, field, line_width_m, segments[i], segments[k])) continue;
        segments[k] = segments.back();
        segments.pop_back();
        if (i == segments.size()) i = k;
        return true;
      }
    }
    return false;
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    while (grow(i)) {  // the grown segment may now reach others; each join takes one away, so this ends
    }
  }
}

}  // namespace touchline
