// SPDX-License-Identifier: Apache-2.0
#include "vision/junctions.h"

namespace touchline {
namespace {

// Two crossings nearer than this are one.
constexpr float same_px = 4.0F;
constexpr float same_widths = 1.5F;
constexpr float merge_sigmas = 1.5F;  // candidates that are known as well as the best count for the place
constexpr float long_branch_widths = 2.5F;
// A branch that the picture cuts off.
constexpr float cut_widths = 0.8F;
constexpr float cut_px = 3.5F;
constexpr float bare_widths = 0.4F;  // so much carpet beside a line ends it
constexpr float bare_px = 2.0F;
constexpr float max_bridge_m = 1.5F;

/// What leaves a crossing in a direction.
enum class Way : std::uint8_t { line, carpet, hidden };

/// Whether the ways at a junction, whose stem is the half line, can be those of a T: no line beyond the bar, and of the
/// bar one half is seen and the other is no carpet.
bool is_half_line_end(const Way* ways, int stem) {
  const Way left = ways[(stem + 1) % 4];
  const Way right = ways[(stem + 3) % 4];
  if (ways[(stem + 2) % 4] == Way::line || left == Way::carpet || right == Way::carpet) return false;
  return left == Way::line || right == Way::line;
}

class JunctionJudge {
 public:
  explicit JunctionJudge(const JunctionSearch& search) : search_(search) {}
  void classify_all();
  void drop_bridges();

 private:
  void merge(std::size_t best);
  void classify(const JunctionCandidate& c);
  void accept_t(const JunctionCandidate& c, const float* directions, int gap, float quality) const;
  /// A place with what a working pixel means there.
  struct Spot {
    GroundPoint ground;
    GroundPixel pixel;
  };
  [[nodiscard]] Way way(const Spot& spot, const Heading& heading) const;
  [[nodiscard]] bool is_long(const Spot& spot, const Heading& heading) const;
  [[nodiscard]] bool is_middle(const Spot& spot, const Heading& heading) const;
  [[nodiscard]] bool goes_on(const Spot& spot, const Heading& heading, float length) const;

  const JunctionSearch& search_;
};

/// Takes up all candidates at the place of the best: their weighted mean.
void JunctionJudge::merge(std::size_t best) {
  JunctionCandidate& c = search_.work.candidates[best];
  const float radius = math::max(same_widths * search_.parameters.line_width_m, 0.0F);
  GroundPoint sum;
  float weights = 0.0F;
  const GroundPixel pixel(search_.rays, c.ground);
  const float surely_apart = (1.0F + pixel_slack) * math::max(radius, same_px * pixel.longest());
  const float surely_same = (1.0F - pixel_slack) * math::max(radius, same_px * pixel.shortest());
  for (JunctionCandidate& other : search_.work.candidates) {
    if (other.taken) continue;
    const float apart = ground_distance(other.ground, c.ground);
    if (apart > surely_apart) continue;
    if (apart > surely_same) {
      const Heading towards(math::atan2(other.ground.y - c.ground.y, other.ground.x - c.ground.x));
      if (apart > math::max(radius, same_px * pixel.along(towards))) continue;
    }
    other.taken = true;
    if (other.sigma > merge_sigmas * c.sigma) continue;
    const float w = 1.0F / math::square(other.sigma);
    sum.x += w * other.ground.x;
    sum.y += w * other.ground.y;
    weights += w;
  }
  c.ground = {sum.x / weights, sum.y / weights};
}

void JunctionJudge::classify_all() {
  for (std::size_t n = 0; n < search_.work.candidates.size(); ++n) {  // each round takes one or more
    std::size_t best = search_.work.candidates.size();
    for (std::size_t i = 0; i < search_.work.candidates.size(); ++i) {
      const JunctionCandidate& c = search_.work.candidates[i];
      if (!c.taken && (best == search_.work.candidates.size() || c.sigma < search_.work.candidates[best].sigma))
        best = i;
    }
    if (best == search_.work.candidates.size()) return;
    merge(best);
    JunctionCandidate& c = search_.work.candidates[best];
    if (on_centre_circle(search_, c.ground)) {
      reject_junction(search_, c, 0, JunctionRejection::curved);
    } else {
      classify(c);
    }
  }
}

/// Whether a line that was seen on both sides of an obstacle runs through the junction in a direction.
bool JunctionJudge::goes_on(const Spot& spot, const Heading& heading, float length) const {
  const GroundPoint& out = heading.out;
  const float aside =
      0.5F * search_.parameters.line_width_m + spot.pixel.along(Heading(wrap_angle(heading.angle + math::half_pi)));
  for (const LineSegment& s : search_.lines.segments) {
    if (s.on_circle || s.is_short || s.sigma > long_line_sigma) continue;
    if (line_angle(s.direction, out) > right_angle_tolerance) continue;
    if (math::abs(distance_across(s, spot.ground)) > aside) continue;
    for (const GroundPoint& end : s.end) {
      if ((end.x - spot.ground.x) * out.x + (end.y - spot.ground.y) * out.y > length) return true;
    }
  }
  return false;
}

/// What leaves the junction in a direction.
Way JunctionJudge::way(const Spot& spot, const Heading& heading) const {
  const float half = 0.5F * search_.parameters.line_width_m;
  const float px = spot.pixel.along(heading);
  const float length = search_.sight.min_branch(px);
  const auto at = [&](float d) {
    return GroundPoint{spot.ground.x + d * heading.out.x, spot.ground.y + d * heading.out.y};
  };
  const Sight branch = search_.sight.look(at(half + 0.5F * px), at(half + 0.5F * px + length));
  // A branch that the picture cuts off is one as far as it goes, when that is far enough.
  const float seen_length = branch.inside * length;
  const bool enough_seen = seen_length >= math::max(cut_widths * search_.parameters.line_width_m, cut_px * px);
  const bool whole = branch.inside >= 1.0F;
  if ((whole || enough_seen) && branch.white >= white_enough * branch.inside &&
      search_.sight.has_flanks(spot.ground, spot.pixel, heading, half + length))
    return Way::line;
  // The mask of the line across reaches a pixel or two beyond its edge.
  const float edge = 1.3F * half + 2.0F * px;
  const float enough = math::max(bare_widths * search_.parameters.line_width_m, bare_px * px);
  const Sight beyond = search_.sight.look(at(edge), at(edge + enough));
  if (!beyond.seen || beyond.middle > dark_enough || beyond.carpet < white_enough) {
    return goes_on(spot, heading, half + length) ? Way::line : Way::hidden;
  }
  return Way::carpet;
}

bool JunctionJudge::is_long(const Spot& spot, const Heading& heading) const {
  const float half = 0.5F * search_.parameters.line_width_m;
  const float length = long_branch_widths * search_.parameters.line_width_m;
  const GroundPoint& out = heading.out;
  const GroundPoint end{spot.ground.x + (half + length) * out.x, spot.ground.y + (half + length) * out.y};
  return search_.sight.look(spot.ground, end).white >= white_enough &&
         search_.sight.has_flanks(spot.ground, spot.pixel, heading, half + length);
}

bool JunctionJudge::is_middle(const Spot& spot, const Heading& heading) const {
  const float px = spot.pixel.along(heading);
  const float from = 0.5F * search_.parameters.line_width_m + px;
  const float to = from + search_.sight.min_branch(px);
  const GroundPoint& out = heading.out;
  return search_.sight
             .look({spot.ground.x + from * out.x, spot.ground.y + from * out.y},
                   {spot.ground.x + to * out.x, spot.ground.y + to * out.y})
             .middle >= white_enough;
}

/// The stem is opposite the missing branch `gap`; counter-clockwise of it the bar.
void JunctionJudge::accept_t(const JunctionCandidate& c, const float* directions, int gap, float quality) const {
  const float ordered[3] = {directions[(gap + 2) % 4], directions[(gap + 3) % 4], directions[(gap + 1) % 4]};
  accept_junction(search_, c, JunctionType::t, ordered, 3, quality);
}

/// Counts the four ways at right angles: X has four, T three, L two that are not opposite.
void JunctionJudge::classify(const JunctionCandidate& c) {
  const CameraPose& pose = search_.rays.projection().pose();
  if (ground_distance(c.ground, {pose.x, pose.y}) > search_.parameters.max_range_m)
    return reject_junction(search_, c, 0, JunctionRejection::too_far);
  if (search_.sight.look(c.ground, c.ground).white < white_enough)
    return reject_junction(search_, c, 0, JunctionRejection::branch_too_short);
  const bool left = angle_difference(c.other, c.heading) > 0.0F;  // `other` is counter-clockwise of `heading`
  const float second = left ? c.other : wrap_angle(c.other + math::pi);
  const float directions[4] = {c.heading, second, wrap_angle(c.heading + math::pi), wrap_angle(second + math::pi)};
  const Spot spot{c.ground, GroundPixel(search_.rays, c.ground)};
  const Heading headings[4] = {Heading(directions[0]), Heading(directions[1]), Heading(directions[2]),
                               Heading(directions[3])};
  bool is_line[4] = {};
  int lines = 0;
  bool hidden = false;
  Way ways[4] = {};
  for (int i = 0; i < 4; ++i) {
    const Way w = way(spot, headings[i]);
    ways[i] = w;
    is_line[i] = w == Way::line;
    lines += is_line[i] ? 1 : 0;
    hidden = hidden || w == Way::hidden;
  }
  // The mask beside a bar may look like a fourth branch; a real one is white in its middle.
  if (lines == 4) {
    bool thin[4] = {};  // beside the middle of a line
    int weak = 0;
    for (int i = 0; i < 4; ++i) {
      thin[i] = !is_middle(spot, headings[i]);
      weak += thin[i] ? 1 : 0;
    }
    for (int i = 0; i < 4 && weak == 1; ++i) is_line[i] = !thin[i];
    if (weak == 1) lines = 3;
  }
  if (lines < 2) return reject_junction(search_, c, lines, JunctionRejection::branch_too_short);
  const float quality = 1.0F - 0.5F * math::min(c.off_angle / max_angle_tolerance, 1.0F);
  // The half line ends at both touch lines: with the centre circle in view, a T there is known by its stem.
  int stem = 0;
  while (stem < 4 && !(is_line[stem] && on_half_line(search_, c.ground, directions[stem]))) ++stem;
  const auto long_half = [&](int i) { return is_line[i % 4] && is_long(spot, headings[i % 4]); };
  if (hidden && stem < 4 && is_half_line_end(ways, stem) && (long_half(stem + 1) || long_half(stem + 3)))
    return accept_t(c, directions, (stem + 2) % 4, quality);
  // Straight lines of a field never cross, so what is behind the bar of a T need not be seen.
  if (hidden && lines < 3) return reject_junction(search_, c, lines, JunctionRejection::at_border);
  if (lines == 4) return accept_junction(search_, c, JunctionType::x, directions, 4, quality);
  if (lines == 3) {
    int gap = 0;
    while (is_line[gap]) ++gap;
    // With what is behind the bar hidden, a foot on a line could be the stem, were it long enough.
    if (hidden && !is_long(spot, headings[(gap + 2) % 4]))
      return reject_junction(search_, c, lines, JunctionRejection::at_border);
    return accept_t(c, directions, gap, quality);
  }
  for (int i = 0; i < 4; ++i) {
    if (!is_line[i] || !is_line[(i + 1) % 4]) continue;
    const float ordered[2] = {directions[i], directions[(i + 1) % 4]};
    return accept_junction(search_, c, JunctionType::l, ordered, 2, quality);
  }
  reject_junction(search_, c, lines, JunctionRejection::straight);
}

/// Two lines a few pixels apart melt here and there, and the bridge looks like a stem with a T at both ends. The one
/// line of a field that ends in two T's is the half line, as long as the field is wide.
void JunctionJudge::drop_bridges() {
  auto& junctions = search_.features.junctions;
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
      if (ground_distance(a.ground, b.ground) > max_bridge_m || !faces(a, b) || !faces(b, a)) continue;
      bridge[i] = bridge[k] = true;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < junctions.size(); ++i) {
    if (bridge[i]) {
      search_.features.rejections.push_back({junctions[i].pixel, 3, JunctionRejection::bridge});
    } else {
      junctions[kept++] = junctions[i];
    }
  }
  junctions.truncate(kept);
}

}  // namespace

int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const FieldView& field,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features) {
  work.candidates.clear();
  const FieldSight sight(rays, field, parameters.line_width_m);
  const JunctionSearch search{lines, circle, rays, field, parameters, sight, work, features};
  cut_circle(search);
  for (std::size_t i = 0; i < lines.segments.size(); ++i) {
    if (lines.segments[i].on_circle) continue;
    scan_for_branches(search, lines.segments[i]);
    find_line_crossings(search, i);
  }
  JunctionJudge judge(search);
  judge.classify_all();
  judge.drop_bridges();
  return static_cast<int>(features.junctions.dropped() + work.candidates.dropped());
}

}  // namespace touchline
