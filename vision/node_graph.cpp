// SPDX-License-Identifier: Apache-2.0
#include "vision/node_graph.h"

#include <bit>
#include <cassert>

#include "vision/image/bit_ops.h"
#include "vision/image/neighbour_words.h"
#include "vision/spurs.h"

namespace touchline {
namespace {

constexpr std::uint16_t of_line = no_node;  // node_of: no node; whether an edge has taken it is in `open`

class Builder {
 public:
  Builder(const SkeletonIndex& skeleton, const NodeGraphMemory& memory)
      : skeleton_(skeleton),
        memory_(memory),
        open_{memory.open.data(), skeleton.width(), skeleton.height(), words_for(skeleton.width())} {
    for (int i = 0; i < skeleton.size(); ++i) memory_.node_of[static_cast<std::size_t>(i)] = of_line;
    for (int y = 0; y < skeleton.height(); ++y) {
      const BitWord* row = skeleton.row(y);
      for (int w = 0; w < open_.stride; ++w) open_.row(y)[w] = row != nullptr ? row[w] : 0;
    }
  }

  void make_fork_nodes();
  void make_major_nodes(std::span<const MajorNode> major_nodes);
  void walk_all();
  void walk_orphans();
  [[nodiscard]] NodeGraphResult result() const;

 private:
  [[nodiscard]] std::uint8_t steps(PixelIndex p) const {
    return skeleton_.steps(skeleton_.pixel(p).x, skeleton_.pixel(p).y);
  }
  [[nodiscard]] PixelIndex step(PixelIndex p, int direction) const {
    const GridPoint at = skeleton_.pixel(p);
    return skeleton_.number_of(at.x + neighbour_dx[direction], at.y + neighbour_dy[direction]);
  }
  [[nodiscard]] bool is_fork(PixelIndex p) const { return count_of(steps(p)) >= 3; }
  [[nodiscard]] bool is_open(int x, int y) const { return (open_.row(y)[word(x)] >> bit(x) & 1U) != 0; }
  void close(int x, int y) { open_.row(y)[word(x)] &= ~(BitWord{1} << bit(x)); }
  void close(PixelIndex p) { close(skeleton_.pixel(p).x, skeleton_.pixel(p).y); }
  static unsigned word(int x) { return static_cast<unsigned>(x) / bits_per_word; }
  static unsigned bit(int x) { return static_cast<unsigned>(x) % bits_per_word; }
  /// The node of a pixel that is not open; of_line when an edge has taken it.
  [[nodiscard]] std::uint16_t node_at(int x, int y) const { return memory_.node_of[skeleton_.number_of(x, y)]; }

  bool add_node(PixelIndex at);
  void gather_fork(PixelIndex seed);
  void walk_component(std::uint16_t seed);
  void walk_from(std::uint16_t node);
  void push(std::uint16_t node) {
    // With one entry a skeleton pixel it cannot fill; were it full, walk_all() comes to the node later.
    if (stacked_ < memory_.stack.size()) memory_.stack[stacked_++] = node;
  }
  void walk_edge(std::uint16_t node, GridPoint from, int direction);
  std::uint16_t follow(GridPoint from, int direction);
  int next_way(int x, int y, unsigned ways) const;
  void join(std::uint16_t a, std::uint16_t b, std::uint32_t first_point);
  void add_point(int x, int y) {
    if (points_ == memory_.points.size()) {
      ++counts_.dropped_points;
      out_of_points_ = true;
      return;
    }
    memory_.points[points_++] = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
  }

  const SkeletonIndex& skeleton_;
  NodeGraphMemory memory_;
  BitView open_;
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
  close(seed);
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
      if (memory_.node_of[q] != of_line || !is_fork(q)) continue;
      memory_.node_of[q] = node;
      close(q);
      memory_.stack[stacked_++] = q;
    }
  }
}

void Builder::make_fork_nodes() {
  for (int y = skeleton_.first_row(); y < skeleton_.height(); ++y) {
    const BitWord* row = skeleton_.row(y);
    for (int w = 0; w < open_.stride; ++w) {
      if (row[w] == 0) continue;
      NeighbourWords n = neighbour_words(skeleton_.row(y - 1), row, skeleton_.row(y + 1), w, open_.stride);
      n.ne &= ~(n.n | n.e);  // as in steps_of()
      n.se &= ~(n.s | n.e);
      n.sw &= ~(n.s | n.w);
      n.nw &= ~(n.n | n.w);
      const NeighbourCount ways = count_neighbours(n);
      for_each_bit(row[w] & ((ways.two & ways.odd) | ways.four), [&](int b) {
        const int x = w * bits_per_word + b;
        if (is_open(x, y)) gather_fork(skeleton_.number_of(x, y));
      });
    }
  }
}

void Builder::make_major_nodes(std::span<const MajorNode> major_nodes) {
  for (const MajorNode& major : major_nodes) {
    if (skeleton_.at(major.at.x, major.at.y) == no_pixel || !is_open(major.at.x, major.at.y)) continue;
    const PixelIndex p = skeleton_.number_of(major.at.x, major.at.y);
    if (!add_node(p)) continue;
    memory_.node_of[p] = static_cast<std::uint16_t>(nodes_ - 1);
    close(p);
    memory_.cluster[clustered_++] = p;
  }
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
  memory_.edges[edges_++] = {a, b, static_cast<std::uint16_t>(first_point), static_cast<std::uint16_t>(count)};
  node_a.edge[node_a.degree++] = edge;
  if (node_b != nullptr) node_b->edge[node_b->degree++] = edge;
}

/// Of the ways from a pixel of a line, one that no edge has taken: the last of several. Negative: the line ends.
int Builder::next_way(int x, int y, unsigned ways) const {
  for (; ways != 0; ways &= ~std::bit_floor(ways)) {
    const int direction = 31 - std::countl_zero(ways);
    const int qx = x + neighbour_dx[direction];
    const int qy = y + neighbour_dy[direction];
    if (is_open(qx, qy) || node_at(qx, qy) != of_line) return direction;
  }
  return -1;
}

/// Adds the points along pixels with two ways, up to the next node, which is returned, or the free end.
std::uint16_t Builder::follow(GridPoint from, int direction) {
  int x = from.x;
  int y = from.y;
  add_point(x, y);
  for (int n = 0; n < skeleton_.size(); ++n) {  // no pixel is walked twice
    const int qx = x + neighbour_dx[direction];
    const int qy = y + neighbour_dy[direction];
    if (!is_open(qx, qy)) {
      const std::uint16_t node = node_at(qx, qy);
      if (node != of_line) add_point(qx, qy);
      return node;  // of_line is no_node
    }
    x = qx;
    y = qy;
    add_point(x, y);
    close(x, y);
    const unsigned ways = skeleton_.steps(x, y) & ~(1U << (static_cast<unsigned>(direction) ^ 4U));
    // Most pixels have one way on: whether it is taken is seen when it is walked.
    direction = (ways & (ways - 1)) == 0 && ways != 0 ? std::countr_zero(ways) : next_way(x, y, ways);
    if (direction < 0) break;
  }
  return no_node;
}

/// From a node's pixel to the next node or the free end.
void Builder::walk_edge(std::uint16_t node, GridPoint from, int direction) {
  const auto first_point = static_cast<std::uint32_t>(points_);
  const std::uint16_t end = follow(from, direction);
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
    const GridPoint p = skeleton_.pixel(memory_.cluster[i]);
    for (unsigned rest = skeleton_.steps(p.x, p.y); rest != 0; rest &= rest - 1) {
      const int direction = std::countr_zero(rest);
      const int x = p.x + neighbour_dx[direction];
      const int y = p.y + neighbour_dy[direction];
      if (!is_open(x, y)) {
        const std::uint16_t owner = node_at(x, y);
        if (owner == of_line || owner <= node) continue;
      }
      walk_edge(node, p, direction);
    }
  }
}

/// Depth first: a node that a walk has reached is walked from before those that were reached earlier.
void Builder::walk_all() {
  for (BitWord& nodes : memory_.expanded) nodes = 0;
  for (std::size_t n = 0; n < nodes_; ++n) walk_component(static_cast<std::uint16_t>(n));
}

void Builder::walk_component(std::uint16_t seed) {
  stacked_ = 0;
  push(seed);
  while (stacked_ > 0) {
    const std::uint16_t node = memory_.stack[--stacked_];
    BitWord& expanded = memory_.expanded[word(node)];
    const BitWord flag = BitWord{1} << bit(node);
    if ((expanded & flag) != 0) continue;
    expanded |= flag;
    walk_from(node);
  }
}

/// What no walk has reached has no node: digestion gave it to a node of another line beside it.
void Builder::walk_orphans() {
  for_each_set_bit(open_, [&](int x, int y) {
    if (!is_open(x, y) || skeleton_.steps(x, y) == 0) return;  // taken since, or a single pixel
    const PixelIndex p = skeleton_.number_of(x, y);
    if (!add_node(p)) return;
    const auto node = static_cast<std::uint16_t>(nodes_ - 1);
    memory_.node_of[p] = node;
    close(p);
    memory_.cluster[clustered_++] = p;
    walk_component(node);
  });
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
  assert(memory.first_pixel.size() >= memory.nodes.size() &&
         memory.expanded.size() * bits_per_word >= memory.nodes.size());
  assert(memory.nodes.size() < no_node && memory.edges.size() < no_node);
  assert(memory.open.size() >= static_cast<std::size_t>(words_for(skeleton.width()) * skeleton.height()));
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
