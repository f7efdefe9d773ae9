// SPDX-License-Identifier: Apache-2.0
#include "vision/circle.h"

#include "platform/core/atan2_lanes.h"
#include "vision/circle_fit.h"
#include "vision/field_sight.h"

namespace touchline {
namespace {

constexpr float bin_width = math::two_pi / static_cast<float>(circle_bins);
constexpr int vote_step = 3;             // every third point begins a vote
constexpr float chord_radii = 1.0F;      // of a vote: 60 degrees of arc, which bulge by 0.13 radii
constexpr float min_chord = 0.7F;        // of it, where the chain ends
constexpr float max_piece_radii = 1.0F;  // a straight stretch longer than this is no arc
constexpr float max_piece_sigma = radians(12.0F);
constexpr float vote_gather_radii = 0.3F;
constexpr float max_noise = 1.5F;  // 1 sigma of a vote's middle point, in bulges
constexpr int max_places = 4;      // a field has one circle; corners and clutter gather votes as well
constexpr float min_arc = radians(60.0F);
constexpr float sure_arc = radians(120.0F);  // of a place that has not the most votes
constexpr int max_gap_bins = 4;              // 20 degrees may be hidden, as by a foot
constexpr float max_off_radii = 0.2F;        // of an arc, however little is known of it
constexpr float beside_radii = 0.35F;
constexpr int max_beside = 20;  // percent of directions with line points beside the circle alone

/// What is seen in a direction from the centre, as bits.
enum : std::uint8_t { on = 1, beside = 2 };

/// A point of a segment, `k` quarters of the way along.
GroundPoint part_of(const LineSegment& s, int k) {
  const float t = static_cast<float>(k) / 4.0F;
  return {s.end[0].x + t * (s.end[1].x - s.end[0].x), s.end[0].y + t * (s.end[1].y - s.end[0].y)};
}

class CircleFinder {
 public:
  CircleFinder(LineSegments& lines, const WorkRays& rays, const CircleParameters& parameters, CircleWork& work)
      : lines_(lines),
        parameters_(parameters),
        work_(work),
        fit_(lines.points.span(), rays, parameters.radius_m, parameters.line_width_m) {}

  bool run(CircleObservation& circle);

 private:
  void withdraw_votes(const GroundPoint& centre);
  [[nodiscard]] bool may_have_arc(const GroundPoint& vote, float least) const;
  bool look_at(const GroundPoint& vote, CircleObservation& circle);
  void vote();
  void vote_by_pieces();
  void vote(std::size_t i, std::size_t middle, std::size_t k);
  [[nodiscard]] bool best_vote(GroundPoint& centre) const;
  float arc(const GroundPoint& centre);
  [[nodiscard]] bool contradicted(const GroundPoint& centre) const;
  void mark(const GroundPoint& centre, RimPoints& rim, std::uint8_t* bins) const;
  void flag_arcs(const GroundPoint& centre);
  void find_half_line(CircleObservation& circle) const;

  LineSegments& lines_;
  const CircleParameters& parameters_;
  CircleWork& work_;
  CircleFit fit_;
};

/// Three points of a chain, a radius apart where the chain is long enough: forks and dirt break a circle's skeleton.
void CircleFinder::vote() {
  work_.votes.clear();
  const auto& points = lines_.points;
  const float chord = chord_radii * parameters_.radius_m;
  constexpr float slack = 1.0e-5F;  // most distances are told without a root: much more than rounding
  const float surely_near = (1.0F - slack) * chord * chord;
  const float surely_far = (1.0F + slack) * chord * chord;
  const auto is_near = [&](const GroundPoint& a, const GroundPoint& b) {
    const float squared = math::square(a.x - b.x) + math::square(a.y - b.y);
    return squared < surely_near || (squared <= surely_far && ground_distance(a, b) < chord);
  };
  std::size_t k = 0;
  for (std::size_t i = 0; i < points.size(); i += vote_step) {
    if (k < i) k = i;
    while (k + 1 < points.size() && points[k + 1].chain == points[i].chain &&
           is_near(points[k].ground, points[i].ground)) {
      ++k;
    }
    if (ground_distance(points[k].ground, points[i].ground) >= min_chord * chord) vote(i, (i + k) / 2, k);
  }
  vote_by_pieces();
}

/// Worn or dirty lines leave chains too short to bulge. Each piece still tells two places: a radius to either side.
void CircleFinder::vote_by_pieces() {
  for (const LineSegment& s : lines_.segments) {
    if (s.length > max_piece_radii * parameters_.radius_m || s.sigma > max_piece_sigma) continue;
    const GroundPoint middle{0.5F * (s.end[0].x + s.end[1].x), 0.5F * (s.end[0].y + s.end[1].y)};
    for (const float r : {parameters_.radius_m, -parameters_.radius_m}) {
      work_.votes.push_back({middle.x - r * s.direction.y, middle.y + r * s.direction.x});
    }
  }
}

void CircleFinder::vote(std::size_t i, std::size_t middle, std::size_t k) {
  const GroundPoint& a = lines_.points[i].ground;
  const GroundPoint& b = lines_.points[k].ground;
  const GroundPoint& m = lines_.points[middle].ground;
  const float r = parameters_.radius_m;
  const float chord = ground_distance(a, b);
  if (!(chord < 1.6F * r) || !(chord > 1.0e-3F)) return;  // a jump in the chain
  const GroundPoint half{0.5F * (a.x + b.x), 0.5F * (a.y + b.y)};
  GroundPoint normal{-(b.y - a.y) / chord, (b.x - a.x) / chord};
  // The middle of the arc lies beyond the chord, seen from the centre.
  const float bulge = (m.x - half.x) * normal.x + (m.y - half.y) * normal.y;
  const float height = math::sqrt(r * r - 0.25F * chord * chord);
  const float expected = r - height;
  const float side = bulge > 0.0F ? -height : height;
  const GroundPoint centre{half.x + side * normal.x, half.y + side * normal.y};
  // Straight lines are most of the chains: the allowance below is never more than what is expected.
  if (math::abs(bulge) < 0.25F * expected || math::abs(bulge) > 2.001F * expected) return;
  // Where a skeleton's noise hides the bulge, a straight line votes like an arc: it has no say.
  const float noise = fit_.sigma(m, centre);
  if (noise > max_noise * expected) return;
  const float allowed = 0.5F * expected + math::min(noise, 0.5F * expected);
  if (math::abs(math::abs(bulge) - expected) > allowed) return;
  work_.votes.push_back(centre);
}

/// The place with most votes; those of places that were tried before do not count.
bool CircleFinder::best_vote(GroundPoint& centre) const {
  const float squared = math::square(vote_gather_radii * parameters_.radius_m);
  const auto near = [squared](const GroundPoint& v, const GroundPoint& w) {
    return math::square(v.x - w.x) + math::square(v.y - w.y) <= squared;
  };
  const GroundPoint* best = nullptr;
  int most = 1;
  for (const GroundPoint& v : work_.votes) {
    int count = 0;
    for (const GroundPoint& w : work_.votes) count += near(v, w) ? 1 : 0;  // no branch: this loop is most of the time
    if (count <= most) continue;
    most = count;
    best = &v;
  }
  if (best == nullptr) return false;
  GroundPoint sum;
  for (const GroundPoint& w : work_.votes) {
    if (!near(*best, w)) continue;
    sum.x += w.x;
    sum.y += w.y;
  }
  centre = {sum.x / static_cast<float>(most), sum.y / static_cast<float>(most)};
  return true;
}

/// Marks the parts of the circle that its arcs cover; the longest run of them, in radians, where gaps up to
/// max_gap_bins count as seen. Only segments that lie on the circle as a whole count: a straight line that touches the
/// circle leaves it.
float CircleFinder::arc(const GroundPoint& centre) {
  for (bool& bin : work_.seen) bin = false;
  for (const LineSegment& s : lines_.segments) {
    if (!s.on_circle) continue;
    const float from = math::atan2(s.end[0].y - centre.y, s.end[0].x - centre.x);
    const float turn = angle_difference(math::atan2(s.end[1].y - centre.y, s.end[1].x - centre.x), from);
    const int steps = static_cast<int>(math::abs(turn) / bin_width) + 1;
    for (int i = 0; i <= steps; ++i) {
      const float angle = wrap_angle(from + turn * static_cast<float>(i) / static_cast<float>(steps)) + math::pi;
      const int bin = static_cast<int>(angle / bin_width);
      work_.seen[bin < circle_bins ? bin : 0] = true;
    }
  }
  int best = 0, run = 0, gap = 0, seen = 0;
  for (int i = 0; i < 2 * circle_bins; ++i) {  // twice round, for the run across the seam
    if (work_.seen[i % circle_bins]) {
      if (i < circle_bins) ++seen;
      run += gap + 1;
      gap = 0;
    } else if (run > 0 && ++gap > max_gap_bins) {
      run = 0;
      gap = 0;
    }
    if (run > best) best = run;
  }
  if (best > circle_bins) best = circle_bins;
  // At least two thirds of the run are to be seen.
  if (3 * seen < 2 * best) return 0.0F;
  return static_cast<float>(best) * bin_width;
}

/// Lines that only touch the circle leave it slowly: they have points beside it, in directions where it has none. A
/// true circle has only the half line beside it.
bool CircleFinder::contradicted(const GroundPoint& centre) const {
  std::uint8_t bins[circle_bins] = {};
  RimPoints rim;
  for (const ChainPoint& p : lines_.points) {
    rim.x[rim.count] = p.ground.x;
    rim.y[rim.count] = p.ground.y;
    rim.count += fit_.in_band(math::square(p.ground.x - centre.x) + math::square(p.ground.y - centre.y)) ? 1 : 0;
    if (rim.count == RimPoints::most) mark(centre, rim, bins);
  }
  mark(centre, rim, bins);
  int bins_on = 0, bins_beside = 0;
  for (const std::uint8_t b : bins) {
    if ((b & on) != 0) {
      ++bins_on;
    } else if (b == beside) {
      ++bins_beside;
    }
  }
  return bins_beside > max_beside * bins_on / 100;
}

/// Marks the directions of some points as those on the circle or beside it.
void CircleFinder::mark(const GroundPoint& centre, RimPoints& rim, std::uint8_t* bins) const {
  fit_.measure(centre, rim);
  int bin[RimPoints::most];
  for (int i = 0; i < rim.count; ++i) {
    bin[i] = static_cast<int>((math::atan2_lane(rim.dy[i], rim.dx[i]) + math::pi) / bin_width);
  }
  for (int i = 0; i < rim.count; ++i) {
    if (math::abs(rim.off[i]) > beside_radii * parameters_.radius_m) continue;
    const bool near = fit_.near_circle(rim.off[i], rim.sigma[i], 1.5F * circle_gate);
    bins[bin[i] < circle_bins ? bin[i] : 0] |= near ? on : beside;
  }
  rim.count = 0;
}

void CircleFinder::flag_arcs(const GroundPoint& centre) {
  for (LineSegment& s : lines_.segments) {
    s.on_circle = true;
    for (int k = 0; k <= 4 && s.on_circle; ++k) {
      const GroundPoint p = part_of(s, k);
      const float off = math::abs(ground_distance(p, centre) - parameters_.radius_m);
      s.on_circle = off < max_off_radii * parameters_.radius_m &&
                    off < 2.0F * fit_.sigma(p, centre) + 0.5F * parameters_.line_width_m;
    }
  }
}

/// The straight segment through the centre that lies nearest to it by what its direction's sigma allows.
void CircleFinder::find_half_line(CircleObservation& circle) const {
  float best = 0.0F;
  for (const LineSegment& s : lines_.segments) {
    if (s.on_circle) continue;
    const GroundPoint to{circle.centre.x - s.end[0].x, circle.centre.y - s.end[0].y};
    const float t = to.x * s.direction.x + to.y * s.direction.y;
    const float off = math::abs(to.x * s.direction.y - to.y * s.direction.x);
    const float beyond = math::max(0.0F, math::max(-t, t - s.length));
    if (beyond > 1.5F * parameters_.radius_m) continue;
    const float allowed =
        0.12F * parameters_.radius_m + 2.0F * s.sigma * (beyond + 0.5F * s.length) + 0.5F * parameters_.line_width_m;
    if (off > math::min(allowed, 0.4F * parameters_.radius_m)) continue;
    const float score = s.length / (s.sigma + radians(1.0F));
    if (score <= best) continue;
    best = score;
    circle.has_half_line = true;
    float direction = math::atan2(s.direction.y, s.direction.x);
    if (direction > math::half_pi) direction -= math::pi;
    if (direction <= -math::half_pi) direction += math::pi;
    circle.half_line_direction = direction;
  }
}

/// Votes for a place that turned out to be no circle, or is one already looked at.
void CircleFinder::withdraw_votes(const GroundPoint& centre) {
  std::size_t kept = 0;
  for (const GroundPoint& vote : work_.votes.span()) {
    if (ground_distance(vote, centre) > vote_gather_radii * parameters_.radius_m) work_.votes[kept++] = vote;
  }
  work_.votes.truncate(kept);
}

/// Whether there are segments near the circle about a vote that could make up two thirds of an arc. Refinement moves a
/// centre by a tenth of a radius; the band is as wide as its own. Most votes are of corners: this tells them cheaply.
bool CircleFinder::may_have_arc(const GroundPoint& vote, float least) const {
  const float r = parameters_.radius_m;
  const float inner = math::square((1.0F - circle_band_radii) * r);
  const float outer = math::square((1.0F + circle_band_radii) * r);
  float turn = 0.0F;  // at most; arc() counts the bins of both ends as well
  for (const LineSegment& s : lines_.segments) {
    bool near = true;
    for (int k = 0; k <= 4 && near; ++k) {
      const GroundPoint p = part_of(s, k);
      const float squared = math::square(p.x - vote.x) + math::square(p.y - vote.y);
      near = squared > inner && squared < outer;
    }
    if (near) turn += 2.0F * s.length / r + 2.0F * bin_width;
  }
  return 3.0F * turn > 2.0F * least;
}

/// Refines the circle at a vote and measures what is seen of it; false where it is none.
bool CircleFinder::look_at(const GroundPoint& vote, CircleObservation& circle) {
  GroundPoint centre = vote;
  Sym2 information;
  float chi = 0.0F;
  if (!fit_.refine(centre, information, chi)) return false;
  flag_arcs(centre);
  const float seen = arc(centre);
  if (seen < min_arc || contradicted(centre)) return false;
  circle = {};
  circle.centre = centre;
  circle.covariance = fit_.covariance(centre, information);
  circle.arc = seen;
  // Full confidence for half a circle whose points scatter as skeleton points do.
  circle.confidence = math::clamp(seen / math::pi, 0.3F, 1.0F) * math::clamp(1.5F - 0.5F * chi, 0.3F, 1.0F);
  return true;
}

bool CircleFinder::run(CircleObservation& circle) {
  vote();
  bool found = false;
  GroundPoint centre;
  for (int tried = 0; tried < max_places && !(found && circle.confidence >= 1.0F) && best_vote(centre); ++tried) {
    CircleObservation other;
    if (may_have_arc(centre, tried == 0 ? min_arc : sure_arc) && look_at(centre, other) &&
        (tried == 0 || other.arc > sure_arc) && (!found || other.confidence > circle.confidence)) {
      circle = other;
      found = true;
    }
    withdraw_votes(centre);
  }
  for (LineSegment& s : lines_.segments) s.on_circle = false;
  if (!found) return false;
  flag_arcs(circle.centre);
  (void)arc(circle.centre);  // leaves what was seen of this one in work_.seen
  find_half_line(circle);
  return true;
}

}  // namespace

bool find_circle(LineSegments& lines, const WorkRays& rays, const CircleParameters& parameters, CircleWork& work,
                 CircleObservation& circle) {
  if (!(parameters.radius_m > 0.0F)) return false;  // a field without circle
  return CircleFinder(lines, rays, parameters, work).run(circle);
}

}  // namespace touchline
