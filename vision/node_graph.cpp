// SPDX-License-Identifier: Apache-2.0
#include "vision/node_graph.h"

#include <bit>
#include <cassert>

#include "vision/spurs.h"

namespace touchline {
namespace {

constexpr std::uint16_t unvisited = no_node;   // node_of: a pixel of a line, not walked yet
constexpr std::uint16_t walked = no_node - 1;  // node_of: a pixel of a line that an edge has taken

class Builder {
 public:
  Builder(const SkeletonIndex& skeleton, const NodeGraphMemory& memory) : skeleton_(skeleton), memory_(memory) {
    for (int i = 0; i < skeleton.size(); ++i) memory_.node_of[static_cast<std::size_t>(i)] = unvisited;
  }

  void make_fork_nodes();
  void make_major_nodes(std::span<const MajorNode> major_nodes);
  void walk_all();
  void walk_orphans();
  [[nodiscard]] NodeGraphResult result() const;

 private:
  [[nodiscard]] std::uint8_t steps(PixelIndex p) const { return steps_of(skeleton_.neighbours(skeleton_.pixel(p))); }
  [[nodiscard]] PixelIndex step(PixelIndex p, int direction) const {
    const GridPoint at = skeleton_.pixel(p);
    return skeleton_.at(at.x + neighbour_dx[direction], at.y + neighbour_dy[direction]);
  }
  [[nodiscard]] bool is_fork(PixelIndex p) const { return count_of(steps(p)) >= 3; }

  bool add_node(PixelIndex at);
  void gather_fork(PixelIndex seed);
  void walk_component(std::uint16_t seed);
  void walk_from(std::uint16_t node);
  void push(std::uint16_t node) {
    // With one entry a skeleton pixel it cannot fill; were it full, walk_all() comes to the node later.
    if (stacked_ < memory_.stack.size()) memory_.stack[stacked_++] = node;
  }
  void walk_edge(std::uint16_t node, PixelIndex from, PixelIndex first);
  void join(std::uint16_t a, std::uint16_t b, std::uint32_t first_point);
  void add_point(PixelIndex p);

  const SkeletonIndex& skeleton_;
  NodeGraphMemory memory_;
  std::size_t nodes_ = 0;
  std::size_t edges_ = 0;
  std::size_t points_ = 0;
  std::size_t clustered_ = 0;
  std::size_t stacked_ = 0;
  bool out_of_points_ = false;
  NodeGraphResult counts_;
};

/// A node whose pixels follow in `cluster`.
bool Builder::add_node(PixelIndex at) {
  if (nodes_ == memory_.nodes.size()) {
    ++counts_.dropped_nodes;
    return false;
  }
  memory_.nodes[nodes_] = GraphNode{};
  memory_.nodes[nodes_].at = skeleton_.pixel(at);
  memory_.first_pixel[nodes_] = static_cast<std::uint16_t>(clustered_);
  ++nodes_;
  return true;
}

/// All forks that touch the seed are one node: thinning leaves a crossing as a small cluster.
void Builder::gather_fork(PixelIndex seed) {
  if (!add_node(seed)) return;
  const auto node = static_cast<std::uint16_t>(nodes_ - 1);
  int most_steps = 0;
  stacked_ = 0;
  memory_.stack[stacked_++] = seed;
  memory_.node_of[seed] = node;
  while (stacked_ > 0) {  // each pixel is stacked once: it is labelled before
    const PixelIndex p = memory_.stack[--stacked_];
    memory_.cluster[clustered_++] = p;
    const std::uint8_t ways = steps(p);
    if (count_of(ways) > most_steps) {
      most_steps = count_of(ways);
      memory_.nodes[node].at = skeleton_.pixel(p);
    }
    for (unsigned rest = ways; rest != 0; rest &= rest - 1) {
      const PixelIndex q = step(p, std::countr_zero(rest));
      if (memory_.node_of[q] != unvisited || !is_fork(q)) continue;
      memory_.node_of[q] = node;
      memory_.stack[stacked_++] = q;
    }
  }
}

void Builder::make_fork_nodes() {
  for (int i = 0; i < skeleton_.size(); ++i) {
    const auto p = static_cast<PixelIndex>(i);
    if (memory_.node_of[p] == unvisited && is_fork(p)) gather_fork(p);
  }
}

void Builder::make_major_nodes(std::span<const MajorNode> major_nodes) {
  for (const MajorNode& major : major_nodes) {
    const PixelIndex p = skeleton_.at(major.at.x, major.at.y);
    if (p == no_pixel || memory_.node_of[p] != unvisited || !add_node(p)) continue;
    memory_.node_of[p] = static_cast<std::uint16_t>(nodes_ - 1);
    memory_.cluster[clustered_++] = p;
  }
}

void Builder::add_point(PixelIndex p) {
  if (points_ == memory_.points.size()) {
    ++counts_.dropped_points;
    out_of_points_ = true;
    return;
  }
  memory_.points[points_++] = skeleton_.pixel(p);
}

/// Takes the points since `first_point` as the edge a-b, or drops them.
void Builder::join(std::uint16_t a, std::uint16_t b, std::uint32_t first_point) {
  const auto count = static_cast<std::uint32_t>(points_) - first_point;
  GraphNode& node_a = memory_.nodes[a];
  GraphNode* node_b = b == no_node ? nullptr : &memory_.nodes[b];
  const bool room_a = node_a.degree < max_degree - (a == b ? 1 : 0);
  const bool room_b = node_b == nullptr || node_b->degree < max_degree;
  if (out_of_points_ || !room_a || !room_b || edges_ == memory_.edges.size()) {
    ++counts_.dropped_edges;
    counts_.dropped_points += static_cast<int>(count);
    points_ = first_point;
    out_of_points_ = false;
    return;
  }
  const auto edge = static_cast<std::uint16_t>(edges_);
  memory_.edges[edges_++] = {a, b, first_point, count};
  node_a.edge[node_a.degree++] = edge;
  if (node_b != nullptr) node_b->edge[node_b->degree++] = edge;
}

/// Along pixels with two ways, from a node's pixel to the next node or the free end.
void Builder::walk_edge(std::uint16_t node, PixelIndex from, PixelIndex first) {
  const auto first_point = static_cast<std::uint32_t>(points_);
  add_point(from);
  PixelIndex previous = from;
  PixelIndex here = first;
  std::uint16_t end = no_node;
  for (int n = 0; n < skeleton_.size(); ++n) {  // no pixel is walked twice
    add_point(here);
    if (memory_.node_of[here] < walked) {
      end = memory_.node_of[here];
      break;
    }
    memory_.node_of[here] = walked;
    PixelIndex next = no_pixel;
    for (unsigned rest = steps(here); rest != 0; rest &= rest - 1) {
      const PixelIndex q = step(here, std::countr_zero(rest));
      if (q != previous && memory_.node_of[q] != walked) next = q;
    }
    if (next == no_pixel) break;
    previous = here;
    here = next;
  }
  if (end == node && points_ - first_point < 5) {  // a hole of some pixels inside a fork, no line
    points_ = first_point;
    out_of_points_ = false;
    return;
  }
  join(node, end, first_point);
  if (end != no_node && end != node) push(end);
}

void Builder::walk_from(std::uint16_t node) {
  const std::size_t last = node + 1U < nodes_ ? memory_.first_pixel[node + 1U] : clustered_;
  for (std::size_t i = memory_.first_pixel[node]; i < last; ++i) {
    const PixelIndex p = memory_.cluster[i];
    for (unsigned rest = steps(p); rest != 0; rest &= rest - 1) {
      const PixelIndex q = step(p, std::countr_zero(rest));
      const std::uint16_t owner = memory_.node_of[q];
      if (owner == node || owner == walked) continue;
      if (owner == unvisited || owner > node) walk_edge(node, p, q);
    }
  }
}

/// Depth first: a node that a walk has reached is walked from before those that were reached earlier.
void Builder::walk_all() {
  for (std::size_t n = 0; n < nodes_; ++n) memory_.expanded[n] = 0;
  for (std::size_t n = 0; n < nodes_; ++n) walk_component(static_cast<std::uint16_t>(n));
}

void Builder::walk_component(std::uint16_t seed) {
  stacked_ = 0;
  push(seed);
  while (stacked_ > 0) {
    const std::uint16_t node = memory_.stack[--stacked_];
    if (memory_.expanded[node] != 0) continue;
    memory_.expanded[node] = 1;
    walk_from(node);
  }
}

/// What no walk has reached has no node: digestion gave it to a node of another line beside it.
void Builder::walk_orphans() {
  for (int i = 0; i < skeleton_.size(); ++i) {
    const auto p = static_cast<PixelIndex>(i);
    if (memory_.node_of[p] != unvisited || steps(p) == 0 || !add_node(p)) continue;
    const auto node = static_cast<std::uint16_t>(nodes_ - 1);
    memory_.node_of[p] = node;
    memory_.cluster[clustered_++] = p;
    memory_.expanded[node] = 0;
    walk_component(node);
  }
}

NodeGraphResult Builder::result() const {
  NodeGraphResult r = counts_;
  r.graph = {memory_.nodes.first(nodes_), memory_.edges.first(edges_), memory_.points.first(points_)};
  return r;
}

}  // namespace

NodeGraphResult build_node_graph(const SkeletonIndex& skeleton, std::span<const MajorNode> major_nodes,
                                 const LineWidthView& line_widths, const NodeGraphParameters& parameters,
                                 const NodeGraphMemory& memory) {
  const auto pixels = static_cast<std::size_t>(skeleton.size());
  assert(memory.node_of.size() >= pixels && memory.cluster.size() >= pixels && memory.stack.size() >= pixels);
  assert(memory.first_pixel.size() >= memory.nodes.size() && memory.expanded.size() >= memory.nodes.size());
  assert(memory.nodes.size() < walked && memory.edges.size() < no_node);
  (void)pixels;
  Builder builder(skeleton, memory);
  builder.make_fork_nodes();
  builder.make_major_nodes(major_nodes);
  builder.walk_all();
  builder.walk_orphans();
  NodeGraphResult result = builder.result();
  const std::size_t kept = prune_spurs(memory.nodes.first(result.graph.nodes.size()),
                                       memory.edges.first(result.graph.edges.size()), line_widths, parameters.spur_px);
  result.spurs = static_cast<int>(result.graph.edges.size() - kept);
  result.graph.edges = memory.edges.first(kept);
  return result;
}

}  // namespace touchline
