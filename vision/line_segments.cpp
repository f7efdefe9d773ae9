// SPDX-License-Identifier: Apache-2.0
#include "vision/line_segments.h"

#include <cassert>

namespace touchline {
namespace {

using RayPoint = LineSegments::RayPoint;

// A skeleton point lies within half a pixel of where thinning sees the middle, and thinning within half a pixel of it.
constexpr float tolerance_px = 1.2F;
// The edges of a wide line are ragged by texture and light; its middle moves by a part of the width.
constexpr float tolerance_widths = 0.12F;
// Thinning rounds a corner within half a width of it.
constexpr float trim_widths = 0.6F;
constexpr float trim_px = 2.0F;
// It moves the ends of a stretch between two forks toward their sharp corners, and so turns short ones.
constexpr float short_widths = 5.0F;
constexpr float short_bend_widths = 0.7F;
constexpr float bend_widths = 0.25F;
constexpr int min_points = 5;
// A fork, a foot or a post may lie between two parts of a line.
constexpr float max_join_gap_m = 0.5F;
constexpr float join_angle = radians(6.0F);

float distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }

class SegmentFinder {
 public:
  SegmentFinder(const NodeGraphView& graph, const WorkRays& rays, const FieldView& field,
                const LineSegmentParameters& parameters, std::span<std::uint8_t> edge_done, LineSegments& out)
      : graph_(graph), rays_(rays), field_(field), parameters_(parameters), edge_done_(edge_done), out_(out) {}

  void run();

 private:
  void read_chain(std::uint16_t edge, std::uint16_t start);
  void append(GridPoint p, bool& gap);
  void flush(bool start_is_fork, bool end_is_fork);
  void split(int first, int last);
  [[nodiscard]] int farthest(int first, int last) const;
  void fit(int first, int last);
  bool measure(LineSegment& s, const Vec3& first, const Vec3& last) const;
  void join_all();
  bool join(LineSegment& a, const LineSegment& b) const;
  [[nodiscard]] bool carpet_between(const GroundPoint& a, const GroundPoint& b) const;
  /// How far a skeleton point may lie off its line, as an angle.
  [[nodiscard]] float tolerance(float depth) const {
    return tolerance_px * rays_.radians_per_pixel() + tolerance_widths * parameters_.line_width_m / depth;
  }
  [[nodiscard]] float depth(int i) const;
  void trim(int& first, int& last) const;

  const NodeGraphView& graph_;
  const WorkRays& rays_;
  const FieldView& field_;
  const LineSegmentParameters& parameters_;
  std::span<std::uint8_t> edge_done_;
  LineSegments& out_;
  std::uint16_t chain_ = 0;
  int stride_ = 1;        // of the chain's points
  int curve_stride_ = 1;  // of the points kept for the circle
  int seen_ = 0;
  bool start_is_fork_ = false;
  bool end_is_fork_ = false;
};

void SegmentFinder::run() {
  out_.segments.clear();
  out_.points.clear();
  std::size_t total = 0;
  for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
    edge_done_[e] = 0;
    total += graph_.edges[e].point_count;
  }
  curve_stride_ = static_cast<int>(total / max_curve_points) + 1;
  // Chains that begin at a fork or at an end first; what is left are loops.
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t e = 0; e < graph_.edges.size(); ++e) {
      const GraphEdge& edge = graph_.edges[e];
      const auto index = static_cast<std::uint16_t>(e);
      if (edge_done_[e] != 0) continue;
      const bool a_ends = graph_.nodes[edge.node_a].degree != 2;
      const bool b_ends = edge.node_b == no_node || graph_.nodes[edge.node_b].degree != 2;
      if (b_ends && !a_ends) {
        read_chain(index, edge.node_b);
      } else if (a_ends || pass == 1) {
        read_chain(index, edge.node_a);
      }
    }
  }
  join_all();
}

/// Reads edge after edge through nodes of degree 2, from the end at node `start` (no_node: the free end).
void SegmentFinder::read_chain(std::uint16_t edge, std::uint16_t start) {
  out_.chain.clear();
  seen_ = 0;
  start_is_fork_ = start != no_node && graph_.nodes[start].degree > 2;
  std::size_t length = 0;
  for (int pass = 0; pass < 2; ++pass) {  // first the length, so that the points fit
    std::uint16_t e = edge;
    std::uint16_t from = start;
    bool gap = false;
    for (std::size_t n = 0; n < graph_.edges.size(); ++n) {  // no edge twice
      const GraphEdge& it = graph_.edges[e];
      const bool forward = it.node_a == from && !(from == no_node);
      const auto line = graph_.polyline(it);
      if (pass == 0) {
        length += line.size();
      } else {
        edge_done_[e] = 1;
        for (std::size_t i = 0; i < line.size(); ++i) append(line[forward ? i : line.size() - 1 - i], gap);
      }
      from = forward ? it.node_b : it.node_a;
      if (from == no_node || graph_.nodes[from].degree != 2) break;
      const GraphNode& node = graph_.nodes[from];
      const std::uint16_t next = node.edge[0] == e ? node.edge[1] : node.edge[0];
      if (next == e || next == edge) break;  // a loop is closed
      e = next;
    }
    stride_ = static_cast<int>(length / max_chain_points) + 1;
    if (pass == 1) flush(start_is_fork_, from != no_node && graph_.nodes[from].degree > 2);
  }
}

/// Adds a point, or ends the stretch where the ground ends.
void SegmentFinder::append(GridPoint p, bool& gap) {
  const int n = seen_++;
  if (n % stride_ != 0) return;
  RayPoint point;
  const GroundProjection& projection = rays_.projection();
  const WorkPoint centre{static_cast<float>(p.x) + 0.5F, static_cast<float>(p.y) + 0.5F};
  const bool seen = rays_.ray(centre, point.ray) && projection.intersect_ground(point.ray, point.ground);
  const float h = projection.pose().height;
  const float range = math::hypot(point.ground.x - projection.pose().x, point.ground.y - projection.pose().y);
  if (!seen || range > parameters_.max_range_m) {
    if (!gap) flush(start_is_fork_, false);
    out_.chain.clear();
    start_is_fork_ = false;
    gap = true;
    return;
  }
  gap = false;
  out_.chain.push_back(point);
  if (n % curve_stride_ == 0) {
    const float per_pixel = (range * range + h * h) / h * rays_.radians_per_pixel();
    out_.points.push_back({point.ground, per_pixel, chain_});
  }
}

void SegmentFinder::flush(bool start_is_fork, bool end_is_fork) {
  start_is_fork_ = start_is_fork;
  end_is_fork_ = end_is_fork;
  const int count = static_cast<int>(out_.chain.size());
  if (count >= min_points) split(0, count - 1);
  ++chain_;
}

/// Distance of a point from the camera, metres.
float SegmentFinder::depth(int i) const {
  return rays_.projection().pose().height / -out_.chain[static_cast<std::size_t>(i)].ray.z;
}

/// The point that is farthest from the plane through both ends, in parts of its tolerance; -1 when all are inside it.
int SegmentFinder::farthest(int first, int last) const {
  const Vec3 across =
      cross(out_.chain[static_cast<std::size_t>(first)].ray, out_.chain[static_cast<std::size_t>(last)].ray);
  // A chain that comes back to where it began has no chord: halve it.
  const bool closed =
      last - first > 2 * min_points && dot(across, across) < math::square(3.0F * rays_.radians_per_pixel());
  if (closed) return (first + last) / 2;
  const Vec3 normal = normalized(across);
  float worst = 1.0F;
  int at = -1;
  for (int i = first + 1; i < last; ++i) {
    const float off = math::abs(dot(normal, out_.chain[static_cast<std::size_t>(i)].ray));
    const float allowed = tolerance(depth(i));
    if (off > worst * allowed) {
      worst = off / allowed;
      at = i;
    }
  }
  return at;
}

void SegmentFinder::split(int first, int last) {
  struct Range {
    int first, last;
  };
  // Each split leaves the nearer part on the stack, and parts have min_points or more.
  StaticVector<Range, max_chain_points / (min_points - 1)> stack;
  stack.push_back({first, last});
  for (std::size_t n = 0; n < 2 * max_chain_points && !stack.empty(); ++n) {
    const Range r = stack.back();
    stack.pop_back();
    if (r.last - r.first + 1 < min_points) continue;
    const int at = farthest(r.first, r.last);
    if (at < 0) {
      fit(r.first, r.last);
      continue;
    }
    stack.push_back({at, r.last});
    stack.push_back({r.first, at});
  }
}

/// Leaves out what thinning has rounded, at corners and forks; free ends are as good as the rest.
void SegmentFinder::trim(int& first, int& last) const {
  const int count = static_cast<int>(out_.chain.size());
  const auto near = [&](int i, int end) {
    const float widths =
        distance(out_.chain[static_cast<std::size_t>(i)].ground, out_.chain[static_cast<std::size_t>(end)].ground) /
        parameters_.line_width_m;
    const int steps = i > end ? i - end : end - i;
    return widths < trim_widths || static_cast<float>(steps * stride_) < trim_px;
  };
  int a = first;
  int b = last;
  if (first > 0 || start_is_fork_) {
    while (a < last && near(a, first)) ++a;
  }
  if (last + 1 < count || end_is_fork_) {
    while (b > a && near(b, last)) --b;
  }
  if (b - a + 1 >= min_points && b - a >= (last - first) / 3) {
    first = a;
    last = b;
  }
}

/// Sums for a plane through the camera near that of two rays: its normal is n0 + a * along + b * towards.
class PlaneFit {
 public:
  PlaneFit(const Vec3& r0, const Vec3& r1)
      : n0_(normalized(cross(r0, r1))),
        along_(normalized({r1.x - r0.x, r1.y - r0.y, r1.z - r0.z})),
        towards_(cross(n0_, along_)) {}
  void add(const Vec3& r) {
    const float x = dot(r, along_);
    const float y = dot(r, n0_);
    const float z = dot(r, towards_);
    xx_ += x * x;
    xz_ += x * z;
    zz_ += z * z;
    xy_ += x * y;
    zy_ += z * y;
  }
  /// The normal for which the sum of squared distances is least; false when the rays span no plane.
  [[nodiscard]] bool solve(Vec3& normal) const {
    const float det = xx_ * zz_ - xz_ * xz_;
    if (!(det > 1.0e-9F)) return false;
    const float a = (-xy_ * zz_ + zy_ * xz_) / det;
    const float b = (-zy_ * xx_ + xy_ * xz_) / det;
    normal = normalized({n0_.x + a * along_.x + b * towards_.x, n0_.y + a * along_.y + b * towards_.y,
                         n0_.z + a * along_.z + b * towards_.z});
    return true;
  }

 private:
  Vec3 n0_, along_, towards_;
  float xx_ = 0.0F, xz_ = 0.0F, zz_ = 0.0F, xy_ = 0.0F, zy_ = 0.0F;
};

void SegmentFinder::fit(int first, int last) {
  const auto ray = [this](int i) -> const Vec3& { return out_.chain[static_cast<std::size_t>(i)].ray; };
  int from = first;
  int to = last;
  trim(from, to);
  PlaneFit plane(ray(from), ray(to));
  for (int i = from; i <= to; ++i) plane.add(ray(i));
  LineSegment s;
  if (!plane.solve(s.normal) || !measure(s, ray(first), ray(last))) return;
  s.chain = chain_;
  s.points = static_cast<std::uint16_t>((last - first + 1) * stride_);
  out_.segments.push_back(s);
}

/// What follows from the plane and the rays near its ends; false when it is too short or not on the ground.
bool SegmentFinder::measure(LineSegment& s, const Vec3& first, const Vec3& last) const {
  const Vec3 ends[2] = {first, last};
  for (int k = 0; k < 2; ++k) {
    const float off = dot(ends[k], s.normal);
    s.end_ray[k] =
        normalized({ends[k].x - off * s.normal.x, ends[k].y - off * s.normal.y, ends[k].z - off * s.normal.z});
    if (!rays_.projection().intersect_ground(s.end_ray[k], s.end[k])) return false;
  }
  s.length = distance(s.end[0], s.end[1]);
  if (s.length < parameters_.line_width_m) return false;
  s.direction = {(s.end[1].x - s.end[0].x) / s.length, (s.end[1].y - s.end[0].y) / s.length};
  const float epsilon = 0.5F * rays_.radians_per_pixel();
  s.is_short = s.length < short_widths * parameters_.line_width_m;
  float shift = math::square((s.is_short ? short_bend_widths : bend_widths) * parameters_.line_width_m);
  for (const Vec3& r : s.end_ray) {  // how far the line moves on the ground when its plane turns by epsilon at this end
    const float reach = rays_.projection().pose().height / -r.z;
    const float dx = reach * (s.normal.x - r.x / r.z * s.normal.z);
    const float dy = reach * (s.normal.y - r.y / r.z * s.normal.z);
    shift += math::square(epsilon * (dx * s.direction.y - dy * s.direction.x));
  }
  s.sigma = math::sqrt(shift) / s.length;
  return true;
}

/// One line of the field, broken by a fork, a foot or a post, becomes one segment again.
void SegmentFinder::join_all() {
  for (std::size_t i = 0; i < out_.segments.size(); ++i) {
    for (std::size_t k = 0; k < out_.segments.size(); ++k) {
      if (k == i || !join(out_.segments[i], out_.segments[k])) continue;
      out_.segments[k] = out_.segments.back();
      out_.segments.pop_back();
      // The grown segment may now reach others; each join takes one away, so this ends.
      if (i == out_.segments.size()) i = k;
      k = static_cast<std::size_t>(-1);
    }
  }
}

/// Whether bare carpet is seen between two points: then no line goes from one to the other.
bool SegmentFinder::carpet_between(const GroundPoint& a, const GroundPoint& b) const {
  WorkPoint from, to;
  if (!rays_.work_point(a, 0.0F, from) || !rays_.work_point(b, 0.0F, to)) return false;
  const float apart = math::max(math::abs(to.u - from.u), math::abs(to.v - from.v));
  const int steps = static_cast<int>(math::clamp(apart + 0.5F, 1.0F, 64.0F));
  int bare = 0;
  for (int i = 0; i <= steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    const int x = static_cast<int>(from.u + t * (to.u - from.u));
    const int y = static_cast<int>(from.v + t * (to.v - from.v));
    bare += field_.green.get(x, y) && !field_.lines.get(x, y) ? 1 : 0;
  }
  return bare > 1 && 3 * bare > steps;
}

/// Joins `b` to `a` when all four ends lie in one plane and the gap between is short.
bool SegmentFinder::join(LineSegment& a, const LineSegment& b) const {
  const float turn = math::abs(a.direction.x * b.direction.y - a.direction.y * b.direction.x);
  if (turn > math::sin(math::min(join_angle + a.sigma + b.sigma, radians(30.0F)))) return false;
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
      const float depth = rays_.projection().pose().height / -r.z;
      if (math::abs(dot(joined.normal, r)) > tolerance(depth)) return false;
    }
  }
  if (!measure(joined, outer[0], outer[1])) return false;
  if (gap > 0.0F && carpet_between(a.end[1 - far_a], b.end[1 - far_b])) return false;
  joined.points = static_cast<std::uint16_t>(a.points + b.points);
  a = joined;
  return true;
}

}  // namespace

void find_line_segments(const NodeGraphView& graph, const WorkRays& rays, const FieldView& field,
                        const LineSegmentParameters& parameters, std::span<std::uint8_t> edge_done, LineSegments& out) {
  assert(edge_done.size() >= graph.edges.size());
  SegmentFinder(graph, rays, field, parameters, edge_done, out).run();
}

}  // namespace touchline
