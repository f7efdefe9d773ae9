// SPDX-License-Identifier: Apache-2.0
#include "vision/circle.h"

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
constexpr int refinements = 6;
constexpr float min_arc = radians(60.0F);
constexpr float sure_arc = radians(120.0F);  // of a place that has not the most votes
constexpr int max_gap_bins = 4;              // 20 degrees may be hidden, as by a foot
constexpr float max_off_radii = 0.2F;        // of an arc, however little is known of it
constexpr float beside_radii = 0.35F;
constexpr int max_beside = 20;       // percent of directions with line points beside the circle alone
constexpr float skeleton_px = 0.8F;  // 1 sigma of a skeleton point
constexpr float rag_widths = 0.15F;  // and what the ragged edge of a wide line adds
constexpr float gate = 2.5F;         // sigmas
constexpr float slack_radii = 0.2F;  // a refinement seldom moves a centre farther
constexpr float band_radii = 0.4F;   // and no point farther off, however little is known of it
constexpr float sigma_tilt = radians(0.5F);

float distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }

/// A point of a segment, `k` quarters of the way along.
GroundPoint part_of(const LineSegment& s, int k) {
  const float t = static_cast<float>(k) / 4.0F;
  return {s.end[0].x + t * (s.end[1].x - s.end[0].x), s.end[0].y + t * (s.end[1].y - s.end[0].y)};
}

/// Points in a wide band about a circle, by their index.
struct NearPoints {
  StaticVector<std::uint16_t, max_curve_points> points;
  GroundPoint centre;
};

class CircleFinder {
 public:
  CircleFinder(LineSegments& lines, const WorkRays& rays, const CircleParameters& parameters, CircleWork& work)
      : lines_(lines), rays_(rays), parameters_(parameters), work_(work) {
    constexpr float slack = 1.01F;  // sigma() adds a little so as not to divide by zero
    const float height = rays.projection().pose().height;
    towards2_ = slack * math::square(rays.radians_per_pixel() * skeleton_px / height);
    tilt2_ = slack * math::square(sigma_tilt * parameters.radius_m / height);
    rag2_ = slack * math::square(rag_widths * parameters.line_width_m);
  }

  bool run(CircleObservation& circle);

 private:
  void withdraw_votes(const GroundPoint& centre);
  [[nodiscard]] bool may_have_arc(const GroundPoint& vote, float least) const;
  bool look_at(const GroundPoint& vote, CircleObservation& circle);
  void vote();
  void vote_by_pieces();
  void vote(std::size_t i, std::size_t middle, std::size_t k);
  [[nodiscard]] bool best_vote(GroundPoint& centre) const;
  [[nodiscard]] float sigma(const GroundPoint& p, const GroundPoint& centre) const {
    return sigma(p, centre, distance(p, centre));
  }
  [[nodiscard]] float sigma(const GroundPoint& p, const GroundPoint& centre, float apart) const;
  void gather(const GroundPoint& centre, NearPoints& near) const;
  [[nodiscard]] bool near_circle(const GroundPoint& p, const GroundPoint& centre, float sigmas, float& off,
                                 float& sigma_m) const;
  bool refine(GroundPoint& centre, Sym2& information, float& chi) const;
  float arc(const GroundPoint& centre);
  [[nodiscard]] bool contradicted(const GroundPoint& centre) const;
  void flag_arcs(const GroundPoint& centre);
  void find_half_line(CircleObservation& circle) const;
  [[nodiscard]] Sym2 covariance(const GroundPoint& centre, const Sym2& information) const;

  LineSegments& lines_;
  const WorkRays& rays_;
  const CircleParameters& parameters_;
  CircleWork& work_;
  float towards2_, tilt2_, rag2_;  // parts of a bound of sigma squared
};

/// Three points of a chain, a radius apart where the chain is long enough: forks and dirt break a circle's skeleton.
void CircleFinder::vote() {
  work_.votes.clear();
  const auto& points = lines_.points;
  const float chord = chord_radii * parameters_.radius_m;
  std::size_t k = 0;
  for (std::size_t i = 0; i < points.size(); i += vote_step) {
    if (k < i) k = i;
    while (k + 1 < points.size() && points[k + 1].chain == points[i].chain &&
           distance(points[k].ground, points[i].ground) < chord) {
      ++k;
    }
    if (distance(points[k].ground, points[i].ground) >= min_chord * chord) vote(i, (i + k) / 2, k);
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
  const float chord = distance(a, b);
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
  const float noise = sigma(m, centre);
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

/// Of a skeleton point, across the circle: what a pixel means in that direction, and the rag of a wide line.
/// `apart` is the distance between both.
float CircleFinder::sigma(const GroundPoint& p, const GroundPoint& centre, float apart) const {
  const CameraPose& pose = rays_.projection().pose();
  const float x = p.x - pose.x;
  const float y = p.y - pose.y;
  const float range = math::hypot(x, y) + 1.0e-6F;
  const float depth = math::hypot(range, pose.height);
  const float across = depth * rays_.radians_per_pixel() * skeleton_px;
  const float towards = across * depth / pose.height;
  const float radius = apart + 1.0e-6F;
  const float c = (x * (p.x - centre.x) + y * (p.y - centre.y)) / (range * radius);
  return math::sqrt(math::square(towards * c) + math::square(across) * (1.0F - c * c) +
                    math::square(rag_widths * parameters_.line_width_m) +
                    math::square(sigma_tilt * range * parameters_.radius_m / pose.height));
}

/// Within `sigmas` of the circle; what that is worth depends on the place.
bool CircleFinder::near_circle(const GroundPoint& p, const GroundPoint& centre, float sigmas, float& off,
                               float& sigma_m) const {
  // Most points are far from the circle: a square tells before a root does. Its bounds are a little wider.
  const float squared = math::square(p.x - centre.x) + math::square(p.y - centre.y);
  if (squared > math::square(1.41F * parameters_.radius_m) || squared < math::square(0.59F * parameters_.radius_m)) {
    return false;
  }
  const float apart = math::sqrt(squared);
  off = apart - parameters_.radius_m;
  if (math::abs(off) > band_radii * parameters_.radius_m) return false;
  // A bound of sigma squared, seen along the ray, takes neither a root nor a division.
  const CameraPose& pose = rays_.projection().pose();
  const float range2 = math::square(p.x - pose.x) + math::square(p.y - pose.y);
  const float most = towards2_ * math::square(range2 + pose.height * pose.height) + tilt2_ * range2 + rag2_;
  if (off * off > sigmas * sigmas * most) return false;
  sigma_m = sigma(p, centre, apart);
  return math::abs(off) < sigmas * sigma_m;
}

/// What near_circle() may accept until the centre has moved by the slack.
void CircleFinder::gather(const GroundPoint& centre, NearPoints& near) const {
  const float inner = math::square((1.0F - band_radii - slack_radii) * parameters_.radius_m);
  const float outer = math::square((1.0F + band_radii + slack_radii) * parameters_.radius_m);
  near.points.clear();
  near.centre = centre;
  for (std::size_t i = 0; i < lines_.points.size(); ++i) {
    const GroundPoint& p = lines_.points[i].ground;
    const float squared = math::square(p.x - centre.x) + math::square(p.y - centre.y);
    if (squared > inner && squared < outer) near.points.push_back(static_cast<std::uint16_t>(i));
  }
}

/// Gauss-Newton on the centre; the radius is known.
bool CircleFinder::refine(GroundPoint& centre, Sym2& information, float& chi) const {
  NearPoints near;
  gather(centre, near);
  for (int n = 0; n < refinements; ++n) {
    const GroundPoint before = centre;
    if (distance(centre, near.centre) > 0.9F * slack_radii * parameters_.radius_m) gather(centre, near);
    information = {};
    float bx = 0.0F, by = 0.0F, sum = 0.0F, weights = 0.0F;
    for (const std::uint16_t i : near.points) {
      const ChainPoint& p = lines_.points[i];
      float off = 0.0F, sigma_m = 1.0F;
      if (!near_circle(p.ground, centre, gate, off, sigma_m)) continue;
      const float d = off + parameters_.radius_m;
      const float ux = (p.ground.x - centre.x) / d;
      const float uy = (p.ground.y - centre.y) / d;
      const float w = 1.0F / (sigma_m * sigma_m);
      information.xx += w * ux * ux;
      information.xy += w * ux * uy;
      information.yy += w * uy * uy;
      bx += w * ux * off;
      by += w * uy * off;
      sum += w * off * off;
      weights += 1.0F;
    }
    const float det = information.xx * information.yy - information.xy * information.xy;
    if (weights < 8.0F || !(det > 1.0e-4F * math::square(information.xx + information.yy))) return false;
    centre.x += (bx * information.yy - by * information.xy) / det;
    centre.y += (by * information.xx - bx * information.xy) / det;
    chi = math::sqrt(sum / weights);
    if (centre.x == before.x && centre.y == before.y) break;  // the next step would say the same
  }
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
  enum : std::uint8_t { nothing = 0, on = 1, beside = 2 };
  std::uint8_t bins[circle_bins] = {};
  const float inner = math::square((0.99F - beside_radii) * parameters_.radius_m);
  const float outer = math::square((1.01F + beside_radii) * parameters_.radius_m);
  for (const ChainPoint& p : lines_.points) {
    const float squared = math::square(p.ground.x - centre.x) + math::square(p.ground.y - centre.y);
    if (squared > outer || squared < inner) continue;  // bounds a little wider than those of the root
    float off = math::sqrt(squared) - parameters_.radius_m;
    if (math::abs(off) > beside_radii * parameters_.radius_m) continue;
    float sigma_m = 1.0F;
    const bool near = near_circle(p.ground, centre, 1.5F * gate, off, sigma_m);
    const float angle = math::atan2(p.ground.y - centre.y, p.ground.x - centre.x) + math::pi;
    const int bin = static_cast<int>(angle / bin_width);
    bins[bin < circle_bins ? bin : 0] |= near ? on : beside;
  }
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

void CircleFinder::flag_arcs(const GroundPoint& centre) {
  for (LineSegment& s : lines_.segments) {
    s.on_circle = true;
    for (int k = 0; k <= 4 && s.on_circle; ++k) {
      const GroundPoint p = part_of(s, k);
      const float off = math::abs(distance(p, centre) - parameters_.radius_m);
      s.on_circle =
          off < max_off_radii * parameters_.radius_m && off < 2.0F * sigma(p, centre) + 0.5F * parameters_.line_width_m;
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

Sym2 CircleFinder::covariance(const GroundPoint& centre, const Sym2& information) const {
  const float det = information.xx * information.yy - information.xy * information.xy;
  // Skeleton points beside each other share their error: count one in four.
  Sym2 c{4.0F * information.yy / det, -4.0F * information.xy / det, 4.0F * information.xx / det};
  PixelPoint pixel;
  if (rays_.projection().pixel(centre, pixel)) {
    const Sym2 tilt = rays_.projection().ground_covariance(pixel, 0.0F, sigma_tilt);
    c.xx += tilt.xx;
    c.xy += tilt.xy;
    c.yy += tilt.yy;
  }
  return c;
}

/// Votes for a place that turned out to be no circle, or is one already looked at.
void CircleFinder::withdraw_votes(const GroundPoint& centre) {
  std::size_t kept = 0;
  for (const GroundPoint& vote : work_.votes.span()) {
    if (distance(vote, centre) > vote_gather_radii * parameters_.radius_m) work_.votes[kept++] = vote;
  }
  work_.votes.truncate(kept);
}

/// Whether there are segments near the circle about a vote that could make up two thirds of an arc. Refinement moves a
/// centre by a tenth of a radius; the band is as wide as its own. Most votes are of corners: this tells them cheaply.
bool CircleFinder::may_have_arc(const GroundPoint& vote, float least) const {
  const float r = parameters_.radius_m;
  const float inner = math::square((1.0F - band_radii) * r);
  const float outer = math::square((1.0F + band_radii) * r);
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
  if (!refine(centre, information, chi)) return false;
  flag_arcs(centre);
  const float seen = arc(centre);
  if (seen < min_arc || contradicted(centre)) return false;
  circle = {};
  circle.centre = centre;
  circle.covariance = covariance(centre, information);
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
