// SPDX-License-Identifier: Apache-2.0
// Candidates for junctions from the line mask. A line whose own direction is well known is followed, and the way square
// to it is looked at on both sides: where it is white for a short piece of the line, a branch begins. Thinning makes
// nothing useful of a branch that is hardly longer than wide; the mask still shows it.
#include "vision/junction_search.h"

namespace touchline {
namespace {

constexpr int min_scan_points = 10;  // skeleton pixels of a line that is followed
constexpr int scan_knot_px = 8;      // the lens is asked this often
constexpr int max_scan_knots = 64;   // a line across the largest working image
constexpr float scan_beyond_px = 5.0F;
constexpr float scan_beyond_widths = 1.0F;
constexpr float least_inside = 0.4F;  // of the way beside a line: of a branch that the picture cuts off
constexpr float stem_widths = 0.25F;  // 1 sigma of a branch's place; the mask fills its sharp corner
constexpr float max_stem_widths = 2.2F;
constexpr float max_stem_px = 4.0F;

class BranchScan {
 public:
  explicit BranchScan(const JunctionSearch& search) : search_(search) {}
  void scan(const LineSegment& s);

 private:
  /// Places along a line where the way square to it is white. The mask fills sharp corners a little; what is white all
  /// the way counts most.
  struct Run {
    float begin = 0.0F, end = 0.0F, sum = 0.0F, weight = 0.0F;
    void add(float t, float white) {
      const float w = math::square(white - white_enough + 0.05F);
      if (!(weight > 0.0F)) begin = t;
      end = t;
      sum += w * t;
      weight += w;
    }
  };
  struct Fence {
    WorkPoint from, to;
  };
  void scan_side(const LineSegment& s, const GroundPoint& out, float direction);
  bool make_fence(const GroundPoint& p, const GroundPoint& out, float direction, Fence& fence) const;
  [[nodiscard]] float white_part(const Fence& a, const Fence& b, float f) const;
  [[nodiscard]] bool dark_beside(const LineSegment& s, float t, const GroundPoint& out, float direction) const;
  void add_stem(const LineSegment& s, const Run& run, float step, const GroundPoint& out, float direction);

  const JunctionSearch& search_;
};

void BranchScan::scan(const LineSegment& s) {
  const float heading = math::atan2(s.direction.y, s.direction.x);
  for (const float side : {1.0F, -1.0F}) {
    const GroundPoint out{-side * s.direction.y, side * s.direction.x};
    scan_side(s, out, wrap_angle(heading + side * math::half_pi));
  }
}

void BranchScan::scan_side(const LineSegment& s, const GroundPoint& out, float direction) {
  const float heading = math::atan2(s.direction.y, s.direction.x);
  const auto along = [&](float t) {
    return GroundPoint{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  };
  const auto beyond = [&](const GroundPoint& end) {
    return scan_beyond_widths * search_.parameters.line_width_m +
           scan_beyond_px * search_.sight.metres_per_px(end, heading);
  };
  float t = -beyond(s.end[0]);
  const float last = s.length + beyond(s.end[1]);
  Run run;
  for (int knot = 0; knot < max_scan_knots && t < last; ++knot) {
    // Between knots a few pixels apart the lens is as good as straight.
    const GroundPoint p = along(t);
    const float step = search_.sight.metres_per_px(p, heading);
    const float knot_end = math::min(t + static_cast<float>(scan_knot_px) * step, last);
    Fence a, b;
    const bool seen = make_fence(p, out, direction, a) && make_fence(along(knot_end), out, direction, b);
    for (int i = 0; i < scan_knot_px; ++i) {
      const float f = static_cast<float>(i) / static_cast<float>(scan_knot_px);
      const float here = t + f * (knot_end - t);
      const float white = seen ? white_part(a, b, f) : 0.0F;
      if (white >= white_enough) {
        run.add(here, white);
      } else if (run.weight > 0.0F) {
        add_stem(s, run, step, out, direction);
        run = {};
      }
    }
    t = knot_end;
  }
}

/// The way square to a line, from its edge out, in working pixels.
bool BranchScan::make_fence(const GroundPoint& p, const GroundPoint& out, float direction, Fence& fence) const {
  const float from = 0.5F * search_.parameters.line_width_m + search_.sight.metres_per_px(p, direction);
  const float to = from + search_.sight.min_branch(p, direction);
  return search_.rays.work_point({p.x + from * out.x, p.y + from * out.y}, 0.0F, fence.from) &&
         search_.rays.work_point({p.x + to * out.x, p.y + to * out.y}, 0.0F, fence.to);
}

/// How much of the way at the part `f` between two fences is white, as far as the picture goes.
float BranchScan::white_part(const Fence& a, const Fence& b, float f) const {
  const auto between = [](float x, float y, float g) { return x + g * (y - x); };
  const float u0 = between(a.from.u, b.from.u, f), v0 = between(a.from.v, b.from.v, f);
  const float u1 = between(a.to.u, b.to.u, f), v1 = between(a.to.v, b.to.v, f);
  const float apart = math::max(math::abs(u1 - u0), math::abs(v1 - v0));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 2.0F, 64.0F));
  int white = 0, inside = 0;
  for (int i = 0; i <= steps; ++i, ++inside) {
    const float g = static_cast<float>(i) / static_cast<float>(steps);
    const float x = between(u0, u1, g);
    const float y = between(v0, v1, g);
    if (!(x >= 0.0F && y >= 0.0F)) break;
    const int column = static_cast<int>(x), row = static_cast<int>(y);
    if (column >= search_.rays.work_width() || row >= search_.rays.work_height()) break;
    white += search_.field.lines.get(column, row) ? 1 : 0;
  }
  const auto all = static_cast<float>(steps + 1);
  return static_cast<float>(white) / math::max(static_cast<float>(inside), least_inside * all);
}

/// Two lines a few pixels apart melt here and there; a branch has carpet on both sides.
bool BranchScan::dark_beside(const LineSegment& s, float t, const GroundPoint& out, float direction) const {
  const GroundPoint p{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  Fence f;
  return !make_fence(p, out, direction, f) || white_part(f, f, 0.0F) <= dark_enough;
}

void BranchScan::add_stem(const LineSegment& s, const Run& run, float step, const GroundPoint& out, float direction) {
  const float t = run.sum / run.weight;
  JunctionCandidate c;
  c.ground = {s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  c.heading = math::atan2(s.direction.y, s.direction.x);
  c.other = direction;
  c.sigma = search_.sight.place_sigma(c.ground, s, stem_widths * search_.parameters.line_width_m);
  const float widest = max_stem_widths * search_.parameters.line_width_m +
                       max_stem_px * search_.sight.metres_per_px(c.ground, c.heading);
  const float aside = 0.5F * search_.parameters.line_width_m + 2.0F * step;
  if (!dark_beside(s, run.begin - aside, out, direction) || !dark_beside(s, run.end + aside, out, direction)) return;
  if (run.end - run.begin + step > widest || !search_.sight.reaches(s, s.direction, c.ground)) return;
  search_.work.candidates.push_back(c);
}

}  // namespace

void scan_for_branches(const JunctionSearch& search, const LineSegment& s) {
  if (!s.is_short && s.sigma < long_line_sigma && s.points >= min_scan_points) BranchScan(search).scan(s);
}

}  // namespace touchline
