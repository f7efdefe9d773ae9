// SPDX-License-Identifier: Apache-2.0
#include "vision/line_segments.h"

#include <cassert>

#include "vision/line_plane.h"
#include "vision/pixel_rays.h"

namespace touchline {
namespace {

using RayPoint = LineSegments::RayPoint;

// Thinning rounds a corner within half a width of it.
constexpr float trim_widths = 0.6F;
constexpr float trim_px = 2.0F;
constexpr int min_points = 5;

float distance(const GroundPoint& a, const GroundPoint& b) { return math::hypot(a.x - b.x, a.y - b.y); }

class SegmentFinder {
 public:
  SegmentFinder(const NodeGraphView& graph, const WorkRays& rays, const FieldView& field,
                const LineSegmentParameters& parameters, std::span<std::uint8_t> edge_done, LineSegments& out)
      : graph_(graph),
        rays_(rays),
        pixel_rays_(rays),
        field_(field),
        parameters_(parameters),
        edge_done_(edge_done),
        out_(out) {}

  void run();

 private:
  void read_chain(std::uint16_t edge, std::uint16_t start);
  void append(GridPoint p, bool& gap);
  void flush(bool start_is_fork, bool end_is_fork);
  void split(int first, int last);
  [[nodiscard]] int farthest(int first, int last) const;
  void fit(int first, int last);
  [[nodiscard]] float depth(int i) const;
  void trim(int& first, int& last) const;

  const NodeGraphView& graph_;
  const WorkRays& rays_;
  PixelRays pixel_rays_;
  const FieldView& field_;
  const LineSegmentParameters& parameters_;
  std::span<std::uint8_t> edge_done_;
  LineSegments& out_;
  std::uint16_t chain_ = 0;
  int stride_ = 1;        // of the chain's points
  int curve_stride_ = 1;  // of the points kept for the circle
  int to_next_ = 0;       // points of the chain that are skipped before the next
  int to_next_curve_ = 0;
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
  join_segments(rays_, field_, parameters_.line_width_m, out_);
}

/// Reads edge after edge through nodes of degree 2, from the end at node `start` (no_node: the free end).
void SegmentFinder::read_chain(std::uint16_t edge, std::uint16_t start) {
  out_.chain.clear();
  to_next_ = to_next_curve_ = 0;
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
  const bool for_curve = to_next_curve_ == 0;
  to_next_curve_ = (for_curve ? curve_stride_ : to_next_curve_) - 1;
  const bool taken = to_next_ == 0;
  to_next_ = (taken ? stride_ : to_next_) - 1;
  if (!taken) return;
  RayPoint point;
  const GroundProjection& projection = rays_.projection();
  const bool seen = pixel_rays_.ray(p, point.ray) && projection.intersect_ground(point.ray, point.ground);
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
  if (for_curve) out_.points.push_back({point.ground, chain_});
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
  const float least_allowed = least_line_tolerance(rays_);
  float worst = 1.0F;
  int at = -1;
  for (int i = first + 1; i < last; ++i) {
    const float off = math::abs(dot(normal, out_.chain[static_cast<std::size_t>(i)].ray));
    if (off <= worst * least_allowed) continue;  // most are: their depth, a division each, need not be known
    const float allowed = line_tolerance(rays_, parameters_.line_width_m, depth(i));
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

void SegmentFinder::fit(int first, int last) {
  const auto ray = [this](int i) -> const Vec3& { return out_.chain[static_cast<std::size_t>(i)].ray; };
  int from = first;
  int to = last;
  trim(from, to);
  PlaneFit plane(ray(from), ray(to));
  for (int i = from; i <= to; ++i) plane.add(ray(i));
  LineSegment s;
  if (!plane.solve(s.normal) || !measure_segment(rays_, parameters_.line_width_m, ray(first), ray(last), s)) return;
  s.chain = chain_;
  s.points = static_cast<std::uint16_t>((last - first + 1) * stride_);
  out_.segments.push_back(s);
}

}  // namespace

void find_line_segments(const NodeGraphView& graph, const WorkRays& rays, const FieldView& field,
                        const LineSegmentParameters& parameters, std::span<std::uint8_t> edge_done, LineSegments& out) {
  assert(edge_done.size() >= graph.edges.size());
  SegmentFinder(graph, rays, field, parameters, edge_done, out).run();
}

}  // namespace touchline
