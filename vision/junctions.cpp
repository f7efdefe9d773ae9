// SPDX-License-Identifier: Apache-2.0
#include "vision/junctions.h"

namespace touchline {
namespace {

// Field lines meet at right angles. A degree or two come from tilt, the rest of the tolerance from the directions'
// sigma.
constexpr float right_angle_tolerance = radians(14.0F);
constexpr float max_angle_tolerance = radians(32.0F);
// The skeleton of a line that ends at another stops within half that line's width of its middle, and thinning pulls
// corners of wide lines in by as much again.
constexpr float reach_widths = 1.2F;
constexpr float reach_px = 3.0F;
// A branch is a line when it goes on for longer than it is wide; marks and spurs are not.
constexpr float min_branch_widths = 1.8F;
constexpr float min_branch_px = 4.0F;
constexpr float same_branch = radians(30.0F);
// Beyond a missing branch the carpet has to be seen, this far from the junction.
constexpr float beyond_widths = 1.5F;
constexpr float beyond_px = 3.0F;
constexpr float sigma_px = 1.0F;             // camera pixels, of the fitted lines' crossing
constexpr float sigma_tilt = radians(0.5F);  // an IMU's error

float angle_between(const GroundPoint& a, const GroundPoint& b) {  // of two directions of lines, 0..pi/2
  return math::atan2(math::abs(a.x * b.y - a.y * b.x), math::abs(a.x * b.x + a.y * b.y));
}

class JunctionFinder {
 public:
  JunctionFinder(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const CarpetView& carpet,
                 const JunctionParameters& parameters, JunctionWork& work, Features& features)
      : lines_(lines),
        circle_(circle),
        rays_(rays),
        carpet_(carpet),
        parameters_(parameters),
        work_(work),
        features_(features) {}

  void pair_up();
  void cut_circle();
  void classify_all();

 private:
  struct Reach {
    float before = 0.0F;  // metres of segment on the near side of the crossing, towards end[0]
    float after = 0.0F;   // and towards end[1]
    bool reaches = false;
  };
  void cut_circle(float side);
  [[nodiscard]] bool arc_seen(float angle, float side) const;
  [[nodiscard]] bool on_circle(const GroundPoint& p) const;
  void consider(std::size_t i, std::size_t k);
  [[nodiscard]] Reach reach(const LineSegment& s, const GroundPoint& at, const Vec3& ray) const;
  void add_branches(JunctionCandidate& c, std::size_t segment, const Reach& r);
  void add_branch(JunctionCandidate& c, const JunctionBranch& b);
  JunctionCandidate* candidate_at(const Vec3& ray, const GroundPoint& at);
  [[nodiscard]] float metres_per_px(const GroundPoint& p, float direction) const;
  [[nodiscard]] float min_branch(const GroundPoint& p, float direction) const;
  void refine(JunctionCandidate& c) const;
  void classify(JunctionCandidate& c);
  [[nodiscard]] bool carpet_beyond(const JunctionCandidate& c, float direction) const;
  void reject(const JunctionCandidate& c, JunctionRejection reason);
  void accept(const JunctionCandidate& c, JunctionType type, const int* order, float off_angle);
  [[nodiscard]] PixelPoint camera_pixel(const GroundPoint& p) const;

  const LineSegments& lines_;
  const SeenCircle* circle_;
  const WorkRays& rays_;
  const CarpetView& carpet_;
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
  c.ground = {guess.x + along * out.x - across * out.y, guess.y + along * out.y + across * out.x};
  const float angle = math::atan2(c.ground.y - circle.centre.y, c.ground.x - circle.centre.x);
  const int ways =
      (inside ? 1 : 0) + (outside ? 1 : 0) + (arc_seen(angle, 1.0F) ? 1 : 0) + (arc_seen(angle, -1.0F) ? 1 : 0);
  for (int k = 0; k < 4; ++k) {
    JunctionBranch b;
    b.direction = wrap_angle(heading + static_cast<float>(k) * math::half_pi);
    b.length = r * static_cast<float>(ways) / 4.0F;
    c.branches.push_back(b);
  }
  if (ways < 3) return reject(c, JunctionRejection::branch_too_short);
  const CameraPose& pose = rays_.projection().pose();
  if (math::hypot(c.ground.x - pose.x, c.ground.y - pose.y) > parameters_.max_range_m)
    return reject(c, JunctionRejection::too_far);
  PixelPoint pixel;
  if (!rays_.projection().pixel(c.ground, pixel)) return reject(c, JunctionRejection::no_ground);
  classify(c);
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

bool JunctionFinder::on_circle(const GroundPoint& p) const {
  if (circle_ == nullptr) return false;
  const GroundPoint& centre = circle_->observation.centre;
  const float off = math::hypot(p.x - centre.x, p.y - centre.y) - circle_->radius_m;
  const float outwards = math::atan2(p.y - centre.y, p.x - centre.x);
  return math::abs(off) < 1.5F * parameters_.line_width_m + 2.0F * metres_per_px(p, outwards);
}

void JunctionFinder::pair_up() {
  const std::size_t count = lines_.segments.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (lines_.segments[i].on_circle) continue;
    for (std::size_t k = 0; k < i; ++k) {
      if (!lines_.segments[k].on_circle) consider(k, i);
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
  return math::max(min_branch_widths * parameters_.line_width_m, min_branch_px * metres_per_px(p, direction));
}

JunctionFinder::Reach JunctionFinder::reach(const LineSegment& s, const GroundPoint& at, const Vec3& ray) const {
  const float t = (at.x - s.end[0].x) * s.direction.x + (at.y - s.end[0].y) * s.direction.y;
  Reach r;
  r.before = t;
  r.after = s.length - t;
  const float outside = math::max(-r.before, -r.after);
  if (outside <= reach_widths * parameters_.line_width_m) {
    r.reaches = true;
  } else {
    const Vec3& end = r.before < r.after ? s.end_ray[0] : s.end_ray[1];
    const Vec3 gap = cross(end, ray);
    r.reaches = dot(gap, gap) < math::square(reach_px * rays_.radians_per_pixel());
  }
  return r;
}

void JunctionFinder::consider(std::size_t i, std::size_t k) {
  const LineSegment& a = lines_.segments[i];
  const LineSegment& b = lines_.segments[k];
  const float angle = angle_between(a.direction, b.direction);
  const float sigma = math::sqrt(a.sigma * a.sigma + b.sigma * b.sigma);
  const float tolerance = math::min(right_angle_tolerance + 2.0F * sigma, max_angle_tolerance);
  const bool right = angle > math::half_pi - tolerance;
  if (angle < radians(20.0F)) return;  // nearly one line: where they cross says nothing
  Vec3 ray = normalized(cross(a.normal, b.normal));
  if (ray.z > 0.0F) ray = {-ray.x, -ray.y, -ray.z};
  GroundPoint at;
  if (!rays_.projection().intersect_ground(ray, at)) return;
  const Reach reach_a = reach(a, at, ray);
  const Reach reach_b = reach(b, at, ray);
  if (!reach_a.reaches || !reach_b.reaches) return;
  JunctionCandidate probe;
  probe.ray = ray;
  probe.ground = at;
  if (!right) {
    add_branches(probe, i, reach_a);
    add_branches(probe, k, reach_b);
    if (probe.branches.size() >= 2)
      reject(probe, a.chain == b.chain ? JunctionRejection::curved : JunctionRejection::bad_angles);
    return;
  }
  JunctionCandidate* c = candidate_at(ray, at);
  if (c == nullptr) return;
  add_branches(*c, i, reach_a);
  add_branches(*c, k, reach_b);
}

JunctionCandidate* JunctionFinder::candidate_at(const Vec3& ray, const GroundPoint& at) {
  for (JunctionCandidate& c : work_.candidates) {
    const Vec3 off = cross(c.ray, ray);
    const float apart = math::hypot(c.ground.x - at.x, c.ground.y - at.y);
    if (dot(off, off) < math::square(reach_px * rays_.radians_per_pixel()) || apart < parameters_.line_width_m)
      return &c;
  }
  JunctionCandidate c;
  c.ray = ray;
  c.ground = at;
  return work_.candidates.push_back(c) ? &work_.candidates.back() : nullptr;
}

void JunctionFinder::add_branches(JunctionCandidate& c, std::size_t segment, const Reach& r) {
  const LineSegment& s = lines_.segments[segment];
  JunctionBranch b;
  b.sigma = s.sigma;
  b.curved = s.on_circle;
  b.segment = static_cast<std::uint16_t>(segment);
  const float forward = math::atan2(s.direction.y, s.direction.x);
  b.direction = forward;
  b.length = r.after;
  if (b.length >= min_branch(c.ground, b.direction)) add_branch(c, b);
  b.direction = wrap_angle(forward + math::pi);
  b.length = r.before;
  if (b.length >= min_branch(c.ground, b.direction)) add_branch(c, b);
}

/// One branch a direction: the longest.
void JunctionFinder::add_branch(JunctionCandidate& c, const JunctionBranch& b) {
  for (JunctionBranch& old : c.branches) {
    if (math::abs(angle_difference(old.direction, b.direction)) > same_branch) continue;
    if (b.length > old.length) old = b;
    return;
  }
  c.branches.push_back(b);
}

/// The ray nearest to all branches' planes: least squares about the candidate's.
void JunctionFinder::refine(JunctionCandidate& c) const {
  const Vec3 u = normalized(cross(c.ray, Vec3{0.0F, 0.0F, 1.0F}));
  const Vec3 v = cross(c.ray, u);
  float uu = 0.0F, uv = 0.0F, vv = 0.0F, ub = 0.0F, vb = 0.0F;
  for (const JunctionBranch& b : c.branches) {
    const Vec3& n = lines_.segments[b.segment].normal;
    const float nu = dot(n, u);
    const float nv = dot(n, v);
    const float off = dot(n, c.ray);
    const float weight = b.curved ? 0.1F : 1.0F;
    uu += weight * nu * nu;
    uv += weight * nu * nv;
    vv += weight * nv * nv;
    ub -= weight * nu * off;
    vb -= weight * nv * off;
  }
  const float det = uu * vv - uv * uv;
  if (!(det > 1.0e-3F)) return;
  const float du = (ub * vv - vb * uv) / det;
  const float dv = (vb * uu - ub * uv) / det;
  const Vec3 ray =
      normalized({c.ray.x + du * u.x + dv * v.x, c.ray.y + du * u.y + dv * v.y, c.ray.z + du * u.z + dv * v.z});
  GroundPoint at;
  if (!rays_.projection().intersect_ground(ray, at)) return;
  c.ray = ray;
  c.ground = at;
}

PixelPoint JunctionFinder::camera_pixel(const GroundPoint& p) const {
  PixelPoint pixel;
  (void)rays_.projection().pixel(p, pixel);
  return pixel;
}

bool JunctionFinder::carpet_beyond(const JunctionCandidate& c, float direction) const {
  const float first = beyond_widths * parameters_.line_width_m + beyond_px * metres_per_px(c.ground, direction);
  for (int step = 0; step < 2; ++step) {
    const float d = first * (step == 0 ? 1.0F : 1.4F);
    const GroundPoint p{c.ground.x + d * math::cos(direction), c.ground.y + d * math::sin(direction)};
    WorkPoint w;
    if (!rays_.work_point(p, 0.0F, w) || !(w.u >= 0.0F && w.v >= 0.0F)) return false;
    const int x = static_cast<int>(w.u);
    const int y = static_cast<int>(w.v);
    if (!carpet_.green.get(x, y) || (carpet_.roi.words != nullptr && !carpet_.roi.get(x, y))) return false;
  }
  return true;
}

void JunctionFinder::reject(const JunctionCandidate& c, JunctionRejection reason) {
  RejectedJunction r;
  r.pixel = camera_pixel(c.ground);
  r.branches = static_cast<std::uint8_t>(c.branches.size());
  r.reason = reason;
  features_.rejections.push_back(r);
}

void JunctionFinder::classify_all() {
  for (JunctionCandidate& c : work_.candidates) {
    refine(c);
    if (on_circle(c.ground)) {
      reject(c, JunctionRejection::curved);
    } else {
      classify(c);
    }
  }
}

/// Sorts the branches counter-clockwise and decides by the angles between neighbours.
void JunctionFinder::classify(JunctionCandidate& c) {
  auto& b = c.branches;
  const CameraPose& pose = rays_.projection().pose();
  if (math::hypot(c.ground.x - pose.x, c.ground.y - pose.y) > parameters_.max_range_m)
    return reject(c, JunctionRejection::too_far);
  if (b.size() < 2) return reject(c, JunctionRejection::branch_too_short);
  if (b.size() > 4) return reject(c, JunctionRejection::too_many_branches);
  for (std::size_t i = 1; i < b.size(); ++i) {  // insertion sort of at most four
    for (std::size_t k = i; k > 0 && b[k].direction < b[k - 1].direction; --k) {
      const JunctionBranch swap = b[k];
      b[k] = b[k - 1];
      b[k - 1] = swap;
    }
  }
  const std::size_t n = b.size();
  float turn[4] = {};  // counter-clockwise from each branch to the next
  float off_angle = 0.0F;
  std::size_t straight = n;  // the branch before a straight angle
  for (std::size_t i = 0; i < n; ++i) {
    turn[i] = b[(i + 1) % n].direction - b[i].direction;
    if (turn[i] <= 0.0F) turn[i] += math::two_pi;
    const float quarters = turn[i] < 0.75F * math::pi ? 1.0F : (turn[i] < 1.25F * math::pi ? 2.0F : 3.0F);
    if (quarters == 2.0F) straight = i;
    off_angle = math::max(off_angle, math::abs(turn[i] - quarters * math::half_pi));
  }
  const auto at = [n](std::size_t i) { return static_cast<int>(i % n); };
  if (n == 4) {
    const int order[4] = {0, 1, 2, 3};
    return accept(c, JunctionType::x, order, off_angle);
  }
  if (n == 3) {
    if (straight == n) return reject(c, JunctionRejection::bad_angles);
    // The bar is straight -> straight + 1; counter-clockwise of the stem comes the branch after it.
    const int order[4] = {at(straight + 2), at(straight + 3), at(straight + 1), 0};
    if (!carpet_beyond(c, wrap_angle(b[static_cast<std::size_t>(order[0])].direction + math::pi)))
      return reject(c, JunctionRejection::at_border);
    return accept(c, JunctionType::t, order, off_angle);
  }
  if (straight != n) return reject(c, JunctionRejection::straight);
  const std::size_t first = turn[0] < math::pi ? 0 : 1;
  for (const JunctionBranch& branch : b) {
    if (!carpet_beyond(c, wrap_angle(branch.direction + math::pi))) return reject(c, JunctionRejection::at_border);
  }
  const int order[4] = {at(first), at(first + 1), 0, 0};
  accept(c, JunctionType::l, order, off_angle);
}

void JunctionFinder::accept(const JunctionCandidate& c, JunctionType type, const int* order, float off_angle) {
  Junction j;
  j.type = type;
  j.ground = c.ground;
  j.pixel = camera_pixel(c.ground);
  j.covariance = rays_.projection().ground_covariance(j.pixel, sigma_px, sigma_tilt);
  j.branches = static_cast<int>(c.branches.size());
  float shortest = 1.0e3F;
  for (int i = 0; i < j.branches; ++i) {
    const JunctionBranch& b = c.branches[static_cast<std::size_t>(order[i])];
    j.direction[static_cast<std::size_t>(i)] = b.direction;
    shortest = math::min(shortest, b.length / parameters_.line_width_m);
  }
  // Half of the confidence goes where branches are barely long enough, or angles barely right.
  const float long_enough = math::clamp(shortest / (3.0F * min_branch_widths), 0.5F, 1.0F);
  const float right_enough = math::clamp(1.0F - 0.5F * off_angle / max_angle_tolerance, 0.5F, 1.0F);
  const CameraPose& pose = rays_.projection().pose();
  const float range = math::hypot(c.ground.x - pose.x, c.ground.y - pose.y);
  const float near_enough = math::clamp(1.25F - 0.25F * range, 0.3F, 1.0F);  // 1 up to 1 m, 0.5 at 3 m
  j.confidence = long_enough * right_enough * near_enough;
  features_.junctions.push_back(j);
}

}  // namespace

int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const CarpetView& carpet,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features) {
  work.candidates.clear();
  JunctionFinder finder(lines, circle, rays, carpet, parameters, work, features);
  finder.cut_circle();
  finder.pair_up();
  finder.classify_all();
  return static_cast<int>(features.junctions.dropped() + work.candidates.dropped());
}

}  // namespace touchline
