// SPDX-License-Identifier: Apache-2.0
#include "vision/line_segments.h"

#include <bit>
#include <cassert>
#include <cstdint>

#include "vision/line_plane.h"
#include "vision/pixel_rays.h"

namespace touchline {
namespace {

// Thinning rounds a corner within half a width of it.
constexpr float trim_widths = 0.6F;
constexpr float trim_px = 2.0F;
constexpr int min_points = 5;
constexpr int points_at_once = 16;

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
  void read_edge(std::span<const GridPoint> line, bool forward);
  void place_on_ground();
  void split_at_gaps(bool end_is_fork);
  void add_stretch(int first, int last);
  void split(int first, int last);
  /// The point that was found: how far it is off, in parts of its tolerance, and which it is.
  struct Farthest {
    float off = 1.0F;
    int at = -1;
  };
  [[nodiscard]] int farthest(int first, int last) const;
  void look_farther(const Vec3& normal, int begin, int end, Farthest& farthest) const;
  void fit(int first, int last);
  void trim(int& first, int& last) const;

  const NodeGraphView& graph_;
  const WorkRays& rays_;
  PixelRays pixel_rays_;
  const FieldView& field_;
  const LineSegmentParameters& parameters_;
  std::span<std::uint8_t> edge_done_;
  LineSegments& out_;
  std::uint16_t chain_ = 0;
  int count_ = 0;         // points of the chain that was read
  int stride_ = 1;        // of them along the skeleton
  int curve_stride_ = 1;  // of the points kept for the circle
  int to_next_ = 0;       // pixels of the chain that are skipped before the next point
  int stretch_first_ = 0, stretch_last_ = 0;
  bool start_is_fork_ = false;
  bool end_is_fork_ = false;
};

/// More straight lines than a field shows are clutter, and its pieces are short.
void keep_longest(LineSegments& lines) {
  auto& segments = lines.segments;
  for (; segments.size() > max_straight_lines; ++lines.left_out) {
    std::size_t shortest = 0;
    for (std::size_t i = 1; i < segments.size(); ++i) {
      if (segments[i].points < segments[shortest].points) shortest = i;
    }
    segments[shortest] = segments.back();
    segments.pop_back();
  }
}

void SegmentFinder::run() {
  out_.segments.clear();
  out_.points.clear();
  out_.left_out = 0;
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
  keep_longest(out_);
}

/// Reads edge after edge through nodes of degree 2, from the end at node `start` (no_node: the free end).
void SegmentFinder::read_chain(std::uint16_t edge, std::uint16_t start) {
  count_ = 0;
  to_next_ = 0;
  start_is_fork_ = start != no_node && graph_.nodes[start].degree > 2;
  std::size_t length = 0;
  for (int pass = 0; pass < 2; ++pass) {  // first the length, so that the points fit
    std::uint16_t e = edge;
    std::uint16_t from = start;
    for (std::size_t n = 0; n < graph_.edges.size(); ++n) {  // no edge twice
      const GraphEdge& it = graph_.edges[e];
      const bool forward = it.node_a == from && !(from == no_node);
      const auto line = graph_.polyline(it);
      if (pass == 0) {
        length += line.size();
      } else {
        edge_done_[e] = 1;
        read_edge(line, forward);
      }
      from = forward ? it.node_b : it.node_a;
      if (from == no_node || graph_.nodes[from].degree != 2) break;
      const GraphNode& node = graph_.nodes[from];
      const std::uint16_t next = node.edge[0] == e ? node.edge[1] : node.edge[0];
      if (next == e || next == edge) break;  // a loop is closed
      e = next;
    }
    stride_ = static_cast<int>(length / max_chain_points) + 1;
    if (pass == 1) split_at_gaps(from != no_node && graph_.nodes[from].degree > 2);
  }
}

/// The rays of every stride_-th pixel.
void SegmentFinder::read_edge(std::span<const GridPoint> line, bool forward) {
  const int size = static_cast<int>(line.size());
  int i = to_next_;
  for (; i < size; i += stride_) {
    Vec3 ray;
    if (!pixel_rays_.ray(line[static_cast<std::size_t>(forward ? i : size - 1 - i)], ray)) ray.z = 0.0F;
    out_.chain.x[count_] = ray.x;
    out_.chain.y[count_] = ray.y;
    out_.chain.z[count_] = ray.z;
    ++count_;  // with the stride that was chosen for it, a chain fits
  }
  to_next_ = i - size;
}

/// As GroundProjection::intersect_ground(), for all points of the chain.
void SegmentFinder::place_on_ground() {
  const CameraPose& pose = rays_.projection().pose();
  LineSegments::Chain& chain = out_.chain;
  for (int i = 0; i < count_; ++i) {
    const float reach = pose.height / -chain.z[i];
    chain.ground_x[i] = pose.x + reach * chain.x[i];
    chain.ground_y[i] = pose.y + reach * chain.y[i];
    const float range = math::hypot(chain.ground_x[i] - pose.x, chain.ground_y[i] - pose.y);
    const bool seen = (chain.z[i] < -GroundProjection::min_descent) & !(range > parameters_.max_range_m);
    chain.z[i] = seen ? chain.z[i] : 0.0F;
  }
}

/// A stretch ends where the ground ends.
void SegmentFinder::split_at_gaps(bool end_is_fork) {
  place_on_ground();
  int first = 0, to_next_curve = 0;
  for (int i = 0; i < count_; ++i) {
    const bool seen = out_.chain.z[i] < 0.0F;
    if (seen && to_next_curve == 0) out_.points.push_back({out_.chain.ground(i), chain_});
    for (to_next_curve -= stride_; to_next_curve < 0;) to_next_curve += curve_stride_;
    if (seen) continue;
    end_is_fork_ = false;
    if (i == 0 || out_.chain.z[i - 1] < 0.0F) add_stretch(first, i - 1);
    first = i + 1;
    start_is_fork_ = false;
  }
  end_is_fork_ = end_is_fork;
  add_stretch(first, count_ - 1);
}

void SegmentFinder::add_stretch(int first, int last) {
  stretch_first_ = first;
  stretch_last_ = last;
  split(first, last);
  ++chain_;
}

/// The point that is farthest from the plane through both ends, in parts of its tolerance; -1 when all are inside it.
int SegmentFinder::farthest(int first, int last) const {
  const LineSegments::Chain& chain = out_.chain;
  const Vec3 across = cross(chain.ray(first), chain.ray(last));
  // A chain that comes back to where it began has no chord: halve it.
  const bool closed =
      last - first > 2 * min_points && dot(across, across) < math::square(3.0F * rays_.radians_per_pixel());
  if (closed) return (first + last) / 2;
  const Vec3 normal = normalized(across);
  const float least_allowed = least_line_tolerance(rays_);
  Farthest farthest;
  for (int begin = first + 1; begin < last; begin += points_at_once) {
    const int end = begin + points_at_once < last ? begin + points_at_once : last;
    const float sure = farthest.off * least_allowed;
    int beyond = 0;  // most blocks have none: their depths, two divisions each, need not be known
    for (int i = begin; i < end; ++i) beyond += math::abs(dot(normal, chain.ray(i))) > sure ? 1 : 0;
    if (beyond != 0) look_farther(normal, begin, end, farthest);
  }
  return farthest.at;
}

/// The same among a few points. All their distances are worked out at once; then those are compared that can win.
void SegmentFinder::look_farther(const Vec3& normal, int begin, int end, Farthest& farthest) const {
  constexpr float slack = 1.0e-5F;  // much more than rounding
  const LineSegments::Chain& chain = out_.chain;
  const float height = rays_.projection().pose().height;
  float off[points_at_once] = {}, allowed[points_at_once] = {};
  std::int32_t parts[points_at_once] = {};  // off / allowed; in bits, whose order is that of numbers above zero
  for (int i = begin; i < end; ++i) {
    off[i - begin] = math::abs(dot(normal, chain.ray(i)));
    allowed[i - begin] = line_tolerance(rays_, parameters_.line_width_m, height / -chain.z[i]);
    parts[i - begin] = std::bit_cast<std::int32_t>(off[i - begin] / allowed[i - begin]);
  }
  std::int32_t most = 0;
  for (int i = 0; i < end - begin; ++i) most = parts[i] > most ? parts[i] : most;
  const float least = (1.0F - slack) * math::max(std::bit_cast<float>(most), farthest.off);
  for (int i = 0; i < end - begin; ++i) {
    if (std::bit_cast<float>(parts[i]) < least || off[i] <= farthest.off * allowed[i]) continue;
    farthest = {off[i] / allowed[i], begin + i};
  }
}

void SegmentFinder::split(int first, int last) {
  struct Range {
    int first, last;
  };
  // Parts share no more than their ends.
  Range stack[max_chain_points / (min_points - 1)];
  int waiting = 0;
  const auto push = [&](const Range& r) {
    if (r.last - r.first + 1 >= min_points) stack[waiting++] = r;
  };
  push({first, last});
  while (waiting > 0) {  // each split makes two smaller parts of one
    const Range r = stack[--waiting];
    const int at = farthest(r.first, r.last);
    if (at < 0) {
      fit(r.first, r.last);
      continue;
    }
    push({at, r.last});
    push({r.first, at});
  }
}

/// Leaves out what thinning has rounded, at corners and forks; free ends are as good as the rest.
void SegmentFinder::trim(int& first, int& last) const {
  const auto near = [&](int i, int end) {
    const float widths = distance(out_.chain.ground(i), out_.chain.ground(end)) / parameters_.line_width_m;
    const int steps = i > end ? i - end : end - i;
    return widths < trim_widths || static_cast<float>(steps * stride_) < trim_px;
  };
  int a = first;
  int b = last;
  if (first > stretch_first_ || start_is_fork_) {
    while (a < last && near(a, first)) ++a;
  }
  if (last < stretch_last_ || end_is_fork_) {
    while (b > a && near(b, last)) --b;
  }
  if (b - a + 1 >= min_points && b - a >= (last - first) / 3) {
    first = a;
    last = b;
  }
}

void SegmentFinder::fit(int first, int last) {
  const LineSegments::Chain& chain = out_.chain;
  int from = first;
  int to = last;
  trim(from, to);
  PlaneFit plane(chain.ray(from), chain.ray(to));
  for (int i = from; i <= to; ++i) plane.add(chain.ray(i));
  LineSegment s;
  if (!plane.solve(s.normal) || !measure_segment(rays_, parameters_.line_width_m, chain.ray(first), chain.ray(last), s))
    return;
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
