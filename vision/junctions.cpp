// SPDX-License-Identifier: Apache-2.0
#include "vision/junctions.h"

namespace touchline {
namespace {

// Field lines meet at right angles; tilt and an uneven carpet turn them by a degree or two on the ground.
constexpr float right_angle_sigma = radians(2.0F);
constexpr float right_angle_tolerance = radians(12.0F);
constexpr float max_angle_tolerance = radians(55.0F);
// A stretch ends where thinning bends the skeleton toward a fork. From there to the crossing the line has to be white.
constexpr float max_gap_px = 25.0F;
constexpr float max_gap_widths = 6.0F;
constexpr float near_px = 3.0F;
constexpr float near_widths = 0.5F;
// A branch is a line when it goes on for longer than it is wide; marks and spurs are not.
constexpr float branch_widths = 2.2F;
constexpr float branch_px = 3.5F;
constexpr float long_branch_widths = 2.5F;
constexpr float cut_widths = 1.2F;
constexpr float bare_widths = 0.4F;  // so much carpet beside a line ends it
constexpr float bare_px = 2.0F;
constexpr float flank_px = 1.5F;
constexpr int flank_samples = 6;
constexpr float present = 0.8F;  // part of a branch that is white
constexpr float absent = 0.5F;
// Two crossings nearer than this are one.
constexpr float same_px = 4.0F;
constexpr float same_widths = 1.5F;
// A line is followed for branches when its own direction is known this well.
constexpr float scan_sigma = radians(4.5F);
constexpr float scan_px = 10.0F;    // working pixels, at least
constexpr int scan_knot_px = 8;     // the lens is asked this often
constexpr int max_scan_knots = 64;  // a line across the largest working image
constexpr float scan_beyond_px = 5.0F;
constexpr float scan_beyond_widths = 1.0F;
constexpr float stem_widths = 0.25F;  // 1 sigma of a branch's place; the mask fills its sharp corner
constexpr float max_stem_widths = 2.2F;
constexpr float max_stem_px = 4.0F;
constexpr float max_bridge_m = 1.5F;
constexpr float moved_part = 1.0F;
constexpr float line_px = 0.4F;  // 1 sigma of a line across, at its middle
constexpr float line_widths = 0.1F;
constexpr float merge_sigmas = 1.5F;         // candidates that are known as well as the best count for the place
constexpr float sigma_px = 1.0F;             // camera pixels, of the lines' crossing
constexpr float sigma_tilt = radians(0.5F);  // an IMU's error

float angle_between(const GroundPoint& a, const GroundPoint& b) {  // of two directions of lines, 0..pi/2
  return math::atan2(math::abs(a.x * b.y - a.y * b.x), math::abs(a.x * b.x + a.y * b.y));
}
/// Distance of a point from a segment's line, > 0 to its left.
float across(const LineSegment& s, const GroundPoint& p) {
  return s.direction.x * (p.y - s.end[0].y) - s.direction.y * (p.x - s.end[0].x);
}
float distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }

class JunctionFinder {
 public:
  JunctionFinder(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const FieldView& field,
                 const JunctionParameters& parameters, JunctionWork& work, Features& features)
      : lines_(lines),
        circle_(circle),
        rays_(rays),
        field_(field),
        parameters_(parameters),
        work_(work),
        features_(features) {}

  void cut_circle();
  void pair_up();
  void classify_all();
  void drop_bridges();

 private:
  enum class Way : std::uint8_t { line, carpet, hidden };

  void cut_circle(float side);
  [[nodiscard]] bool arc_seen(float angle, float side) const;
  [[nodiscard]] bool on_circle(const GroundPoint& p) const;
  void consider(const LineSegment& a, const LineSegment& b);
  [[nodiscard]] bool reaches(const LineSegment& s, const GroundPoint& direction, const GroundPoint& at) const;
  [[nodiscard]] float metres_per_px(const GroundPoint& p, float direction) const;
  [[nodiscard]] float min_branch(const GroundPoint& p, float direction) const;
  struct Sight {          // parts of the way
    float white = 0.0F;   // on a line, or beside one by a pixel
    float middle = 0.0F;  // on a line
    float carpet = 0.0F;  // on carpet or on a line
    float inside = 0.0F;  // in the picture, from its beginning on
    bool seen = true;     // all of it lies in the picture and in the region of interest
  };
  [[nodiscard]] Sight look(const GroundPoint& from, const GroundPoint& to) const;
  [[nodiscard]] bool is_long(const JunctionCandidate& c, float direction) const;
  [[nodiscard]] bool is_middle(const JunctionCandidate& c, float direction) const;
  [[nodiscard]] bool has_flanks(const JunctionCandidate& c, float direction, float length) const;
  [[nodiscard]] bool goes_on(const JunctionCandidate& c, float direction, float length) const;
  [[nodiscard]] Way way(const JunctionCandidate& c, float direction) const;
  [[nodiscard]] float place_sigma(const GroundPoint& p, const LineSegment& a, float along) const;
  void scan(const LineSegment& s);
  void scan_side(const LineSegment& s, const GroundPoint& out, float direction);
  /// Places along a line where the way square to it is white. The mask fills sharp corners a little; what is white all
  /// the way counts most.
  struct Run {
    float begin = 0.0F, end = 0.0F, sum = 0.0F, weight = 0.0F;
    void add(float t, float white) {
      const float w = math::square(white - present + 0.05F);
      if (!(weight > 0.0F)) begin = t;
      end = t;
      sum += w * t;
      weight += w;
    }
  };
  struct Fence {
    WorkPoint from, to;
  };
  bool make_fence(const GroundPoint& p, const GroundPoint& out, float direction, Fence& fence) const;
  [[nodiscard]] float white_part(const Fence& a, const Fence& b, float f) const;
  void add_stem(const LineSegment& s, const Run& run, float step, const GroundPoint& out, float direction);
  [[nodiscard]] bool dark_beside(const LineSegment& s, float t, const GroundPoint& out, float direction) const;
  void merge(std::size_t best);
  void classify(const JunctionCandidate& c);
  void reject(const JunctionCandidate& c, int branches, JunctionRejection reason);
  void accept(const JunctionCandidate& c, JunctionType type, const float* directions, int count, float quality);

  const LineSegments& lines_;
  const SeenCircle* circle_;
  const WorkRays& rays_;
  const FieldView& field_;
  const JunctionParameters& parameters_;
  JunctionWork& work_;
  Features& features_;
};

/// The two X's: where the half line cuts the centre circle.
void JunctionFinder::cut_circle() {
  if (circle_ == nullptr || !circle_->observation.has_half_line) return;
  cut_circle(1.0F);
  cut_circle(-1.0F);
}

void JunctionFinder::cut_circle(float side) {
  const CircleObservation& circle = circle_->observation;
  const float r = circle_->radius_m;
  const float heading = side > 0.0F ? circle.half_line_direction : wrap_angle(circle.half_line_direction + math::pi);
  const GroundPoint out{math::cos(heading), math::sin(heading)};
  const GroundPoint guess{circle.centre.x + r * out.x, circle.centre.y + r * out.y};
  bool inside = false, outside = false;
  float weight = 0.0F, offset = 0.0F;  // of the half line beside the guess, to the left of `out`
  for (const LineSegment& s : lines_.segments) {
    if (s.on_circle || angle_between(s.direction, out) > radians(12.0F) + 2.0F * s.sigma) continue;
    const float t = (guess.x - s.end[0].x) * s.direction.x + (guess.y - s.end[0].y) * s.direction.y;
    const GroundPoint foot{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
    const float off = (foot.x - guess.x) * -out.y + (foot.y - guess.y) * out.x;
    const float outwards = s.direction.x * out.x + s.direction.y * out.y;
    const float before = outwards > 0.0F ? t : s.length - t;  // of the segment, towards the centre
    const float after = s.length - before;
    if (math::abs(off) > 1.5F * parameters_.line_width_m + 2.0F * metres_per_px(guess, heading + math::half_pi))
      continue;
    if (math::max(-before, -after) > 0.5F * r) continue;
    const float enough = min_branch(guess, heading);
    inside = inside || (before > enough && -after < 0.5F * r);
    outside = outside || (after > enough && -before < 0.5F * r);
    const float w = s.length / (s.sigma + radians(1.0F));
    weight += w;
    offset += w * off;
  }
  if (!inside && !outside) return;
  offset /= weight;
  // Along the half line to the circle: the line misses the centre by `offset`.
  const float across = math::clamp(offset, -0.5F * r, 0.5F * r);
  const float along = math::sqrt(r * r - across * across) - r;
  JunctionCandidate c;
  c.heading = heading;
  c.sigma = 1.0F;
  c.ground = {guess.x + along * out.x - across * out.y, guess.y + along * out.y + across * out.x};
  const float angle = math::atan2(c.ground.y - circle.centre.y, c.ground.x - circle.centre.x);
  const int ways =
      (inside ? 1 : 0) + (outside ? 1 : 0) + (arc_seen(angle, 1.0F) ? 1 : 0) + (arc_seen(angle, -1.0F) ? 1 : 0);
  if (ways < 3) return reject(c, ways, JunctionRejection::branch_too_short);
  const CameraPose& pose = rays_.projection().pose();
  if (distance(c.ground, {pose.x, pose.y}) > parameters_.max_range_m)
    return reject(c, ways, JunctionRejection::too_far);
  float directions[4];
  for (int k = 0; k < 4; ++k) directions[k] = wrap_angle(heading + static_cast<float>(k) * math::half_pi);
  accept(c, JunctionType::x, directions, 4, 0.25F * static_cast<float>(ways));
}

/// Whether most of the arc from 10 to 35 degrees beside an angle about the centre was seen.
bool JunctionFinder::arc_seen(float angle, float side) const {
  int seen = 0;
  for (int k = 0; k < 6; ++k) {
    const float at = wrap_angle(angle + side * radians(10.0F + 5.0F * static_cast<float>(k))) + math::pi;
    const int bin = static_cast<int>(at / math::two_pi * static_cast<float>(circle_bins));
    seen += circle_->seen[bin < circle_bins ? bin : 0] ? 1 : 0;
  }
  return seen >= 4;
}

/// On the centre circle or inside it, where the half line is alone.
bool JunctionFinder::on_circle(const GroundPoint& p) const {
  if (circle_ == nullptr) return false;
  const GroundPoint& centre = circle_->observation.centre;
  const float off = math::hypot(p.x - centre.x, p.y - centre.y) - circle_->radius_m;
  const float outwards = math::atan2(p.y - centre.y, p.x - centre.x);
  return off < 1.5F * parameters_.line_width_m + 2.0F * metres_per_px(p, outwards);
}

void JunctionFinder::pair_up() {
  const std::size_t count = lines_.segments.size();
  for (std::size_t i = 0; i < count; ++i) {
    const LineSegment& a = lines_.segments[i];
    if (a.on_circle) continue;
    if (!a.is_short && a.sigma < scan_sigma && static_cast<float>(a.points) >= scan_px) scan(a);
    for (std::size_t k = 0; k < i; ++k) {
      const LineSegment& b = lines_.segments[k];
      if (b.on_circle) continue;
      if (a.sigma < b.sigma) {
        consider(a, b);
      } else {
        consider(b, a);
      }
    }
  }
}

/// Metres on the ground of a working pixel, in a direction.
float JunctionFinder::metres_per_px(const GroundPoint& p, float direction) const {
  const CameraPose& pose = rays_.projection().pose();
  const float x = p.x - pose.x;
  const float y = p.y - pose.y;
  const float range = math::hypot(x, y);
  const float depth = math::hypot(range, pose.height);
  const float across = depth * rays_.radians_per_pixel();
  const float towards = across * depth / pose.height;
  if (!(range > 1.0e-3F)) return across;
  const float c = (x * math::cos(direction) + y * math::sin(direction)) / range;
  return math::sqrt(math::square(towards * c) + math::square(across) * (1.0F - c * c));
}

float JunctionFinder::min_branch(const GroundPoint& p, float direction) const {
  return math::max(branch_widths * parameters_.line_width_m, branch_px * metres_per_px(p, direction));
}

/// What lies on the way between two ground points, a sample a working pixel.
JunctionFinder::Sight JunctionFinder::look(const GroundPoint& from, const GroundPoint& to) const {
  Sight sight;
  WorkPoint a, b;
  if (!rays_.work_point(from, 0.0F, a) || !rays_.work_point(to, 0.0F, b)) return {0.0F, 0.0F, 0.0F, 0.0F, false};
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
    const bool line = field_.lines.get(x, y) || field_.lines.get(x - 1, y) || field_.lines.get(x + 1, y) ||
                      field_.lines.get(x, y - 1) || field_.lines.get(x, y + 1);
    white += line ? 1 : 0;
    const bool strict = field_.lines.get(x, y);
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

/// Whether a stretch goes up to a point on its line: it covers it, or nearly, or the line is white in between.
bool JunctionFinder::reaches(const LineSegment& s, const GroundPoint& direction, const GroundPoint& at) const {
  const float before = (s.end[0].x - at.x) * direction.x + (s.end[0].y - at.y) * direction.y;
  const float after = (s.end[1].x - at.x) * direction.x + (s.end[1].y - at.y) * direction.y;
  if (before * after <= 0.0F) return true;
  const bool first = math::abs(before) < math::abs(after);
  const float gap = math::abs(first ? before : after);
  const float heading = math::atan2(direction.y, direction.x);
  const float px = metres_per_px(at, heading);
  if (gap <= math::max(near_widths * parameters_.line_width_m, near_px * px)) return true;
  if (gap > math::min(max_gap_px * px, max_gap_widths * parameters_.line_width_m + near_px * px)) return false;
  return look(first ? s.end[0] : s.end[1], at).white >= present;
}

/// How well a crossing on the line `a` is known, working pixels: `a` across itself, and `along` metres along it.
float JunctionFinder::place_sigma(const GroundPoint& p, const LineSegment& a, float along) const {
  const GroundPoint middle{0.5F * (a.end[0].x + a.end[1].x), 0.5F * (a.end[0].y + a.end[1].y)};
  const float heading = math::atan2(a.direction.y, a.direction.x);
  const float rag = line_widths * parameters_.line_width_m;
  const float off =
      math::hypot(a.sigma * distance(middle, p), rag) / metres_per_px(p, wrap_angle(heading + math::half_pi));
  const float ahead = math::hypot(along, rag) / metres_per_px(p, heading);
  return math::sqrt(off * off + ahead * ahead + 2.0F * line_px * line_px);
}

/// `a` is the one whose direction is known better. A short `b` tells where it is better than how it is turned, and
/// lines of a field are at right angles: its direction is the mean of both, weighted by what they are good for.
void JunctionFinder::consider(const LineSegment& a, const LineSegment& b) {
  const float angle = angle_between(a.direction, b.direction);
  if (angle < radians(30.0F)) return;  // nearly one line: where they cross says nothing
  GroundPoint square{-a.direction.y, a.direction.x};
  if (square.x * b.direction.x + square.y * b.direction.y < 0.0F) square = {-square.x, -square.y};
  const float off = math::atan2(square.x * b.direction.y - square.y * b.direction.x,
                                square.x * b.direction.x + square.y * b.direction.y);
  const float sigma_b = b.sigma;
  const float tolerance = math::min(right_angle_tolerance + 2.0F * sigma_b, max_angle_tolerance);
  const float prior = right_angle_sigma * right_angle_sigma + a.sigma * a.sigma;
  const bool right = math::abs(off) <= tolerance;
  const float turn = right ? off * prior / (prior + sigma_b * sigma_b) : off;
  const float c = math::cos(turn);
  const float s = math::sin(turn);
  const GroundPoint direction_b{c * square.x - s * square.y, s * square.x + c * square.y};
  // A long one is taken from its end beside the crossing, where what its direction is off matters least.
  const float side[2] = {math::abs(across(a, b.end[0])), math::abs(across(a, b.end[1]))};
  const GroundPoint middle = b.is_short
                                 ? GroundPoint{0.5F * (b.end[0].x + b.end[1].x), 0.5F * (b.end[0].y + b.end[1].y)}
                                 : b.end[side[0] < side[1] ? 0 : 1];
  const float det = a.direction.x * direction_b.y - a.direction.y * direction_b.x;
  const float t =
      ((middle.x - a.end[0].x) * direction_b.y - (middle.y - a.end[0].y) * direction_b.x) / det;  // det is near +-1
  JunctionCandidate found;
  found.ground = {a.end[0].x + t * a.direction.x, a.end[0].y + t * a.direction.y};
  found.heading = math::atan2(a.direction.y, a.direction.x);
  found.other = math::atan2(direction_b.y, direction_b.x);
  found.off_angle = math::abs(off);
  // A plane's direction is best at its own middle; b was turned about the point it is taken from.
  const float turned = math::sqrt(prior * sigma_b * sigma_b / (prior + sigma_b * sigma_b));
  const float lever = distance(middle, found.ground);
  // What it is off from a right angle tells how far thinning has moved its ends.
  const float moved = moved_part * 0.5F * b.length * math::sin(math::abs(off));
  found.sigma = place_sigma(found.ground, a, math::hypot(turned * lever, moved));
  if (!reaches(a, a.direction, found.ground) || !reaches(b, direction_b, found.ground)) return;
  if (!right) {
    return reject(found, 2, a.chain == b.chain ? JunctionRejection::curved : JunctionRejection::bad_angles);
  }
  work_.candidates.push_back(found);
}

/// Follows a line and looks square to it on both sides: where the way is white for a short piece of the line, a branch
/// begins. Thinning makes nothing useful of a branch that is hardly longer than wide; the mask still shows it.
void JunctionFinder::scan(const LineSegment& s) {
  const float heading = math::atan2(s.direction.y, s.direction.x);
  for (const float side : {1.0F, -1.0F}) {
    const GroundPoint out{-side * s.direction.y, side * s.direction.x};
    scan_side(s, out, wrap_angle(heading + side * math::half_pi));
  }
}

void JunctionFinder::scan_side(const LineSegment& s, const GroundPoint& out, float direction) {
  const float heading = math::atan2(s.direction.y, s.direction.x);
  const auto along = [&](float t) {
    return GroundPoint{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  };
  const auto beyond = [&](const GroundPoint& end) {
    return scan_beyond_widths * parameters_.line_width_m + scan_beyond_px * metres_per_px(end, heading);
  };
  float t = -beyond(s.end[0]);
  const float last = s.length + beyond(s.end[1]);
  Run run;
  for (int knot = 0; knot < max_scan_knots && t < last; ++knot) {
    // Between knots a few pixels apart the lens is as good as straight.
    const GroundPoint p = along(t);
    const float step = metres_per_px(p, heading);
    const float knot_end = math::min(t + static_cast<float>(scan_knot_px) * step, last);
    Fence a, b;
    const bool seen = make_fence(p, out, direction, a) && make_fence(along(knot_end), out, direction, b);
    for (int i = 0; i < scan_knot_px; ++i) {
      const float f = static_cast<float>(i) / static_cast<float>(scan_knot_px);
      const float here = t + f * (knot_end - t);
      const float white = seen ? white_part(a, b, f) : 0.0F;
      if (white >= present) {
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
bool JunctionFinder::make_fence(const GroundPoint& p, const GroundPoint& out, float direction, Fence& fence) const {
  const float from = 0.5F * parameters_.line_width_m + metres_per_px(p, direction);
  const float to = from + min_branch(p, direction);
  return rays_.work_point({p.x + from * out.x, p.y + from * out.y}, 0.0F, fence.from) &&
         rays_.work_point({p.x + to * out.x, p.y + to * out.y}, 0.0F, fence.to);
}

/// How much of the way at the part `f` between two fences is white.
float JunctionFinder::white_part(const Fence& a, const Fence& b, float f) const {
  const auto between = [](float x, float y, float g) { return x + g * (y - x); };
  const float u0 = between(a.from.u, b.from.u, f), v0 = between(a.from.v, b.from.v, f);
  const float u1 = between(a.to.u, b.to.u, f), v1 = between(a.to.v, b.to.v, f);
  const float apart = math::max(math::abs(u1 - u0), math::abs(v1 - v0));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 2.0F, 64.0F));
  int white = 0;
  for (int i = 0; i <= steps; ++i) {
    const float g = static_cast<float>(i) / static_cast<float>(steps);
    const float x = between(u0, u1, g);
    const float y = between(v0, v1, g);
    white += x >= 0.0F && y >= 0.0F && field_.lines.get(static_cast<int>(x), static_cast<int>(y)) ? 1 : 0;
  }
  return static_cast<float>(white) / static_cast<float>(steps + 1);
}

/// Two lines a few pixels apart melt here and there; a branch has carpet on both sides.
bool JunctionFinder::dark_beside(const LineSegment& s, float t, const GroundPoint& out, float direction) const {
  const GroundPoint p{s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  Fence f;
  return !make_fence(p, out, direction, f) || white_part(f, f, 0.0F) <= absent;
}

void JunctionFinder::add_stem(const LineSegment& s, const Run& run, float step, const GroundPoint& out,
                              float direction) {
  const float t = run.sum / run.weight;
  JunctionCandidate c;
  c.ground = {s.end[0].x + t * s.direction.x, s.end[0].y + t * s.direction.y};
  c.heading = math::atan2(s.direction.y, s.direction.x);
  c.other = direction;
  c.sigma = place_sigma(c.ground, s, stem_widths * parameters_.line_width_m);
  const float widest = max_stem_widths * parameters_.line_width_m + max_stem_px * metres_per_px(c.ground, c.heading);
  const float aside = 0.5F * parameters_.line_width_m + 2.0F * step;
  if (!dark_beside(s, run.begin - aside, out, direction) || !dark_beside(s, run.end + aside, out, direction)) return;
  if (run.end - run.begin + step > widest || !reaches(s, s.direction, c.ground)) return;
  work_.candidates.push_back(c);
}

/// Takes up all candidates at the place of the best: their weighted mean.
void JunctionFinder::merge(std::size_t best) {
  JunctionCandidate& c = work_.candidates[best];
  const float radius = math::max(same_widths * parameters_.line_width_m, 0.0F);
  GroundPoint sum;
  float weights = 0.0F;
  for (JunctionCandidate& other : work_.candidates) {
    if (other.taken) continue;
    const float towards = math::atan2(other.ground.y - c.ground.y, other.ground.x - c.ground.x);
    const float apart = distance(other.ground, c.ground);
    if (apart > math::max(radius, same_px * metres_per_px(c.ground, towards))) continue;
    other.taken = true;
    if (other.sigma > merge_sigmas * c.sigma) continue;
    const float w = 1.0F / math::square(other.sigma);
    sum.x += w * other.ground.x;
    sum.y += w * other.ground.y;
    weights += w;
  }
  c.ground = {sum.x / weights, sum.y / weights};
}

void JunctionFinder::classify_all() {
  for (std::size_t n = 0; n < work_.candidates.size(); ++n) {  // each round takes one or more
    std::size_t best = work_.candidates.size();
    for (std::size_t i = 0; i < work_.candidates.size(); ++i) {
      const JunctionCandidate& c = work_.candidates[i];
      if (!c.taken && (best == work_.candidates.size() || c.sigma < work_.candidates[best].sigma)) best = i;
    }
    if (best == work_.candidates.size()) return;
    merge(best);
    JunctionCandidate& c = work_.candidates[best];
    if (on_circle(c.ground)) {
      reject(c, 0, JunctionRejection::curved);
    } else {
      classify(c);
    }
  }
}

/// Whether carpet is seen on both sides of a branch. A post or a foot that stands on a line may look like one.
bool JunctionFinder::has_flanks(const JunctionCandidate& c, float direction, float length) const {
  const GroundPoint out{math::cos(direction), math::sin(direction)};
  const float px = metres_per_px(c.ground, wrap_angle(direction + math::half_pi));
  const float aside = 0.75F * parameters_.line_width_m + flank_px * px;
  for (const float side : {1.0F, -1.0F}) {
    int carpet = 0, other = 0;
    for (int i = 0; i < flank_samples; ++i) {
      const float d = length * (static_cast<float>(i) + 1.0F) / static_cast<float>(flank_samples);
      WorkPoint w;
      const GroundPoint p{c.ground.x + d * out.x - side * aside * out.y, c.ground.y + d * out.y + side * aside * out.x};
      if (!rays_.work_point(p, 0.0F, w) || !(w.u >= 0.0F && w.v >= 0.0F)) continue;
      const int x = static_cast<int>(w.u);
      const int y = static_cast<int>(w.v);
      if (x >= rays_.work_width() || y >= rays_.work_height() || field_.lines.get(x, y)) continue;
      if (field_.carpet.get(x, y)) {
        ++carpet;
      } else {
        ++other;
      }
    }
    if (other > carpet) return false;
  }
  return true;
}

/// Whether a line that was seen on both sides of an obstacle runs through the junction in a direction.
bool JunctionFinder::goes_on(const JunctionCandidate& c, float direction, float length) const {
  const GroundPoint out{math::cos(direction), math::sin(direction)};
  const float aside =
      near_widths * parameters_.line_width_m + metres_per_px(c.ground, wrap_angle(direction + math::half_pi));
  for (const LineSegment& s : lines_.segments) {
    if (s.on_circle || s.is_short || s.sigma > scan_sigma) continue;
    if (angle_between(s.direction, out) > right_angle_tolerance) continue;
    if (math::abs(across(s, c.ground)) > aside) continue;
    for (const GroundPoint& end : s.end) {
      if ((end.x - c.ground.x) * out.x + (end.y - c.ground.y) * out.y > length) return true;
    }
  }
  return false;
}

/// What leaves the junction in a direction.
JunctionFinder::Way JunctionFinder::way(const JunctionCandidate& c, float direction) const {
  const float half = 0.5F * parameters_.line_width_m;
  const float px = metres_per_px(c.ground, direction);
  const float length = min_branch(c.ground, direction);
  const GroundPoint out{math::cos(direction), math::sin(direction)};
  const auto at = [&](float d) { return GroundPoint{c.ground.x + d * out.x, c.ground.y + d * out.y}; };
  const Sight branch = look(at(half + 0.5F * px), at(half + 0.5F * px + length));
  // A branch that the picture cuts off is one as far as it goes, when that is far enough.
  const float seen_length = branch.inside * length;
  const bool enough_seen = seen_length >= math::max(cut_widths * parameters_.line_width_m, branch_px * px);
  const bool whole = branch.inside >= 1.0F;
  if ((whole || enough_seen) && branch.white >= present * branch.inside && has_flanks(c, direction, half + length))
    return Way::line;
  // The mask of the line across reaches a pixel or two beyond its edge.
  const float edge = 1.3F * half + 2.0F * px;
  const float enough = math::max(bare_widths * parameters_.line_width_m, bare_px * px);
  const Sight beyond = look(at(edge), at(edge + enough));
  if (!beyond.seen || beyond.middle > absent || beyond.carpet < present) {
    return goes_on(c, direction, half + length) ? Way::line : Way::hidden;
  }
  return Way::carpet;
}

bool JunctionFinder::is_long(const JunctionCandidate& c, float direction) const {
  const float half = 0.5F * parameters_.line_width_m;
  const float length = long_branch_widths * parameters_.line_width_m;
  const GroundPoint out{math::cos(direction), math::sin(direction)};
  const GroundPoint end{c.ground.x + (half + length) * out.x, c.ground.y + (half + length) * out.y};
  return look(c.ground, end).white >= present && has_flanks(c, direction, half + length);
}

bool JunctionFinder::is_middle(const JunctionCandidate& c, float direction) const {
  const float from = 0.5F * parameters_.line_width_m + metres_per_px(c.ground, direction);
  const float to = from + min_branch(c.ground, direction);
  const GroundPoint out{math::cos(direction), math::sin(direction)};
  return look({c.ground.x + from * out.x, c.ground.y + from * out.y},
              {c.ground.x + to * out.x, c.ground.y + to * out.y})
             .middle >= present;
}

/// Counts the four ways at right angles: X has four, T three, L two that are not opposite.
void JunctionFinder::classify(const JunctionCandidate& c) {
  const CameraPose& pose = rays_.projection().pose();
  if (distance(c.ground, {pose.x, pose.y}) > parameters_.max_range_m) return reject(c, 0, JunctionRejection::too_far);
  if (look(c.ground, c.ground).white < present) return reject(c, 0, JunctionRejection::branch_too_short);
  const bool left = angle_difference(c.other, c.heading) > 0.0F;  // `other` is counter-clockwise of `heading`
  const float second = left ? c.other : wrap_angle(c.other + math::pi);
  const float directions[4] = {c.heading, second, wrap_angle(c.heading + math::pi), wrap_angle(second + math::pi)};
  bool is_line[4] = {};
  bool thin[4] = {};  // a line, but beside the middle
  int lines = 0;
  bool hidden = false;
  for (int i = 0; i < 4; ++i) {
    const Way w = way(c, directions[i]);
    is_line[i] = w == Way::line;
    thin[i] = is_line[i] && !is_middle(c, directions[i]);
    lines += is_line[i] ? 1 : 0;
    hidden = hidden || w == Way::hidden;
  }
  // The mask beside a bar may look like a fourth branch; a real one is white in its middle.
  if (lines == 4) {
    int weak = 0;
    for (const bool t : thin) weak += t ? 1 : 0;
    for (int i = 0; i < 4 && weak == 1; ++i) is_line[i] = !thin[i];
    if (weak == 1) lines = 3;
  }
  if (lines < 2) return reject(c, lines, JunctionRejection::branch_too_short);
  // Straight lines of a field never cross, so what is behind the bar of a T need not be seen.
  if (hidden && lines < 3) return reject(c, lines, JunctionRejection::at_border);
  const float quality = 1.0F - 0.5F * math::min(c.off_angle / max_angle_tolerance, 1.0F);
  if (lines == 4) return accept(c, JunctionType::x, directions, 4, quality);
  if (lines == 3) {
    int gap = 0;
    while (is_line[gap]) ++gap;
    // The stem is opposite the missing branch; counter-clockwise of it the bar.
    // With what is behind the bar hidden, a foot on a line could be the stem, were it long enough.
    if (hidden && !is_long(c, directions[(gap + 2) % 4])) return reject(c, lines, JunctionRejection::at_border);
    const float ordered[3] = {directions[(gap + 2) % 4], directions[(gap + 3) % 4], directions[(gap + 1) % 4]};
    return accept(c, JunctionType::t, ordered, 3, quality);
  }
  for (int i = 0; i < 4; ++i) {
    if (!is_line[i] || !is_line[(i + 1) % 4]) continue;
    const float ordered[2] = {directions[i], directions[(i + 1) % 4]};
    return accept(c, JunctionType::l, ordered, 2, quality);
  }
  reject(c, lines, JunctionRejection::straight);
}

/// Two lines a few pixels apart melt here and there, and the bridge looks like a stem with a T at both ends. The one
/// line of a field that ends in two T's is the half line, as long as the field is wide.
void JunctionFinder::drop_bridges() {
  auto& junctions = features_.junctions;
  const auto faces = [](const Junction& a, const Junction& b) {
    const float towards = math::atan2(b.ground.y - a.ground.y, b.ground.x - a.ground.x);
    return math::abs(angle_difference(a.direction[0], towards)) < radians(25.0F);
  };
  bool bridge[max_junctions] = {};
  for (std::size_t i = 0; i < junctions.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Junction& a = junctions[i];
      const Junction& b = junctions[k];
      if (a.type != JunctionType::t || b.type != JunctionType::t) continue;
      if (distance(a.ground, b.ground) > max_bridge_m || !faces(a, b) || !faces(b, a)) continue;
      bridge[i] = bridge[k] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < junctions.size(); ++i) {
    if (bridge[i]) {
      features_.rejections.push_back({junctions[i].pixel, 3, JunctionRejection::bridge});
    } else {
      junctions[kept++] = junctions[i];
    }
  }
  junctions.truncate(kept);
}

void JunctionFinder::reject(const JunctionCandidate& c, int branches, JunctionRejection reason) {
  RejectedJunction r;
  (void)rays_.projection().pixel(c.ground, r.pixel);
  r.branches = static_cast<std::uint8_t>(branches);
  r.reason = reason;
  features_.rejections.push_back(r);
}

void JunctionFinder::accept(const JunctionCandidate& c, JunctionType type, const float* directions, int count,
                            float quality) {
  Junction j;
  if (!rays_.projection().pixel(c.ground, j.pixel)) return reject(c, count, JunctionRejection::no_ground);
  j.type = type;
  j.ground = c.ground;
  j.covariance = rays_.projection().ground_covariance(j.pixel, sigma_px, sigma_tilt);
  j.branches = count;
  for (int i = 0; i < count; ++i) j.direction[static_cast<std::size_t>(i)] = directions[i];
  const CameraPose& pose = rays_.projection().pose();
  const float range = distance(c.ground, {pose.x, pose.y});
  const float near_enough = math::clamp(1.25F - 0.25F * range, 0.3F, 1.0F);  // 1 up to 1 m, 0.5 at 3 m
  const float sure = math::clamp(1.2F - 0.2F * c.sigma, 0.3F, 1.0F);
  j.confidence = quality * near_enough * sure;
  features_.junctions.push_back(j);
}

}  // namespace

int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const FieldView& field,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features) {
  work.candidates.clear();
  JunctionFinder finder(lines, circle, rays, field, parameters, work, features);
  finder.cut_circle();
  finder.pair_up();
  finder.classify_all();
  finder.drop_bridges();
  return static_cast<int>(features.junctions.dropped() + work.candidates.dropped());
}

}  // namespace touchline
