// SPDX-License-Identifier: Apache-2.0
// Candidates for junctions from the line mask. A line whose own direction is well known is followed, and the way square
// to it is looked at on both sides: where it is white for a short piece of the line, a branch begins. Thinning makes
// nothing useful of a branch that is hardly longer than wide; the mask still shows it.
#include <algorithm>
#include <array>
#include <span>

#include "vision/image/bit_ops.h"
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
  BranchScan(const JunctionSearch& search, const LineSegment& line)
      : search_(search), line_(line), along_(math::atan2(line.direction.y, line.direction.x)) {}
  void scan();

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
  /// The way out on one side of the line.
  struct Side {
    GroundPoint out;
    Heading heading;
  };
  struct Fence {
    WorkPoint from, to;
    bool seen = false;  // by the lens
  };
  /// A place along the line.
  struct Knot {
    float t = 0.0F;
    float step = 0.0F;  // a working pixel along the line, metres
    GroundPixel pixel;
  };
  void place_knots();
  void scan_side(const Side& side);
  void scan_between(std::size_t k, const Fence& fence, const Fence& next, const Side& side, Run& run);
  [[nodiscard]] GroundPoint at(float t) const {
    return {line_.end[0].x + t * line_.direction.x, line_.end[0].y + t * line_.direction.y};
  }
  static constexpr std::size_t max_fences = RayLanes::most / 2;
  using Fences = std::array<Fence, max_fences>;
  [[nodiscard]] Fences fences_at(std::span<const Knot> knots, const Side& side) const;
  [[nodiscard]] bool in_picture(const WorkPoint& p) const;
  [[nodiscard]] bool none_white(const Fence& a, const Fence& b) const;
  [[nodiscard]] float white_part(const Fence& a, const Fence& b, float f, float least) const;
  [[nodiscard]] bool dark_beside(float t, const Side& side) const;
  void add_stem(const Run& run, float step, const Side& side);

  const JunctionSearch& search_;
  const LineSegment& line_;
  Heading along_;
  StaticVector<Knot, max_scan_knots + 1> knots_;
};

float between(float x, float y, float f) { return x + f * (y - x); }
WorkPoint between(const WorkPoint& a, const WorkPoint& b, float f) {
  return {between(a.u, b.u, f), between(a.v, b.v, f)};
}

void BranchScan::scan() {
  place_knots();
  for (const float side : {1.0F, -1.0F}) {
    scan_side({{-side * line_.direction.y, side * line_.direction.x},
               Heading(wrap_angle(along_.angle + side * math::half_pi))});
  }
}

/// Between knots a few pixels apart the lens is as good as straight.
void BranchScan::place_knots() {
  const auto beyond = [&](const GroundPoint& end) {
    return scan_beyond_widths * search_.parameters.line_width_m +
           scan_beyond_px * search_.sight.metres_per_px(end, along_);
  };
  float t = -beyond(line_.end[0]);
  const float last = line_.length + beyond(line_.end[1]);
  for (bool more = true; more;) {
    Knot knot{t, 0.0F, GroundPixel(search_.rays, at(t))};
    knot.step = knot.pixel.along(along_);
    more = knots_.push_back(knot) && t < last;
    t = math::min(t + static_cast<float>(scan_knot_px) * knot.step, last);
  }
}

void BranchScan::scan_side(const Side& side) {
  Run run;
  Fence fence;
  for (std::size_t first = 0; first < knots_.size(); first += max_fences) {
    const std::size_t count = std::min(knots_.size() - first, max_fences);
    const Fences fences = fences_at({&knots_[first], count}, side);
    for (std::size_t k = 0; k < count; ++k) {
      if (first + k > 0) scan_between(first + k - 1, fence, fences[k], side, run);
      fence = fences[k];
    }
  }
}

/// From one knot to the next.
void BranchScan::scan_between(std::size_t k, const Fence& fence, const Fence& next, const Side& side, Run& run) {
  const Knot& knot = knots_[k];
  const float length = knots_[k + 1].t - knot.t;
  const bool dark = !fence.seen || !next.seen || none_white(fence, next);
  for (int i = 0; i < (dark ? 1 : scan_knot_px); ++i) {
    const float f = static_cast<float>(i) / static_cast<float>(scan_knot_px);
    const float white = dark ? 0.0F : white_part(fence, next, f, white_enough);
    if (white >= white_enough) {
      run.add(knot.t + f * length, white);
    } else if (run.weight > 0.0F) {
      add_stem(run, knot.step, side);
      run = {};
    }
  }
}

/// The ways square to the line at some places, from its edge out, in working pixels.
BranchScan::Fences BranchScan::fences_at(std::span<const Knot> knots, const Side& side) const {
  RayLanes ends;
  for (const Knot& knot : knots) {
    const GroundPoint p = at(knot.t);
    const float px = knot.pixel.along(side.heading);
    const float from = 0.5F * search_.parameters.line_width_m + px;
    const float to = from + search_.sight.min_branch(px);
    ends.add({p.x + from * side.out.x, p.y + from * side.out.y});
    ends.add({p.x + to * side.out.x, p.y + to * side.out.y});
  }
  search_.rays.work_points(ends);
  Fences fences;
  for (std::size_t i = 0; i < knots.size(); ++i) {
    fences[i] = {{ends.u[2 * i], ends.v[2 * i]},
                 {ends.u[2 * i + 1], ends.v[2 * i + 1]},
                 ends.seen[2 * i] + ends.seen[2 * i + 1] == 2};
  }
  return fences;
}

constexpr float slack = 0.01F;  // px, for rounding

/// Surely: so is then what lies between two such points.
bool BranchScan::in_picture(const WorkPoint& p) const {
  return p.u >= slack && p.v >= slack && p.u < static_cast<float>(search_.rays.work_width()) - slack &&
         p.v < static_cast<float>(search_.rays.work_height()) - slack;
}

/// Whether no way between two fences can be white enough, told by a look at the box around their outer quarter: most
/// lines have carpet beside them. A way of n samples has n / 4 or more of them there, and a fifth is too much.
bool BranchScan::none_white(const Fence& a, const Fence& b) const {
  if (!in_picture(a.from) || !in_picture(a.to) || !in_picture(b.from) || !in_picture(b.to)) return false;
  const WorkPoint c = between(a.from, a.to, 0.75F);
  const WorkPoint d = between(b.from, b.to, 0.75F);
  const float left = math::min(math::min(a.to.u, b.to.u), math::min(c.u, d.u));
  const float right = math::max(math::max(a.to.u, b.to.u), math::max(c.u, d.u));
  const float top = math::min(math::min(a.to.v, b.to.v), math::min(c.v, d.v));
  const float bottom = math::max(math::max(a.to.v, b.to.v), math::max(c.v, d.v));
  return !any_set(search_.field.lines, static_cast<int>(left - slack), static_cast<int>(top - slack),
                  static_cast<int>(right + slack), static_cast<int>(bottom + slack));
}

/// How much of the way at the part `f` between two fences is white, as far as the picture goes; 0 where that is surely
/// less than `least`.
float BranchScan::white_part(const Fence& a, const Fence& b, float f, float least) const {
  const WorkPoint from = between(a.from, b.from, f);
  const WorkPoint to = between(a.to, b.to, f);
  const float apart = math::max(math::abs(to.u - from.u), math::abs(to.v - from.v));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 2.0F, 64.0F));
  const auto all = static_cast<float>(steps + 1);
  const int most_dark = static_cast<int>((1.001F - least) * all);
  const auto part = [&](int i) { return between(from, to, static_cast<float>(i) / static_cast<float>(steps)); };
  if (in_picture(from) && in_picture(to)) {  // from its outer end on, where most ways are dark
    int dark = 0;
    for (int i = steps; i >= 0; --i) {
      const WorkPoint p = part(i);
      dark += search_.field.lines.get(static_cast<int>(p.u), static_cast<int>(p.v)) ? 0 : 1;
      if (dark > most_dark) return 0.0F;
    }
    return static_cast<float>(steps + 1 - dark) / all;
  }
  int white = 0, inside = 0;
  for (int i = 0; i <= steps; ++i, ++inside) {
    const WorkPoint p = part(i);
    if (!(p.u >= 0.0F && p.v >= 0.0F)) break;
    const int column = static_cast<int>(p.u), row = static_cast<int>(p.v);
    if (column >= search_.rays.work_width() || row >= search_.rays.work_height()) break;
    white += search_.field.lines.get(column, row) ? 1 : 0;
    if (i + 1 - white > most_dark) return 0.0F;
  }
  return static_cast<float>(white) / math::max(static_cast<float>(inside), least_inside * all);
}

/// Two lines a few pixels apart melt here and there; a branch has carpet on both sides.
bool BranchScan::dark_beside(float t, const Side& side) const {
  const Knot knot{t, 0.0F, GroundPixel(search_.rays, at(t))};
  const Fence f = fences_at({&knot, 1}, side)[0];
  return !f.seen || white_part(f, f, 0.0F, dark_enough) <= dark_enough;
}

void BranchScan::add_stem(const Run& run, float step, const Side& side) {
  const float t = run.sum / run.weight;
  JunctionCandidate c;
  c.ground = at(t);
  c.heading = along_.angle;
  c.other = side.heading.angle;
  const float widest =
      max_stem_widths * search_.parameters.line_width_m + max_stem_px * search_.sight.metres_per_px(c.ground, along_);
  if (run.end - run.begin + step > widest || !search_.sight.reaches(line_, line_.direction, c.ground)) return;
  const float aside = 0.5F * search_.parameters.line_width_m + 2.0F * step;
  if (!dark_beside(run.begin - aside, side) || !dark_beside(run.end + aside, side)) return;
  c.sigma = search_.sight.place_sigma(c.ground, line_, stem_widths * search_.parameters.line_width_m);
  search_.work.candidates.push_back(c);
}

}  // namespace

void scan_for_branches(const JunctionSearch& search, const LineSegment& s) {
  if (!s.is_short && s.sigma < long_line_sigma && s.points >= min_scan_points) BranchScan(search, s).scan();
}

}  // namespace touchline
