// SPDX-License-Identifier: Apache-2.0
#include "vision/spurs.h"

namespace touchline {
namespace {

int spur_limit(GridPoint at, const LineWidthView& line_widths, int spur_px) {
  if (line_widths.data == nullptr) return spur_px;
  const LineWidth& width = line_widths.at(at.x / width_block_px, at.y / width_block_px);
  const int wider = width.across_row > width.across_column ? width.across_row : width.across_column;
  const int by_width = wider * 3 / 4 / 16;  // the table is in 1/16 pixel
  return by_width > spur_px ? by_width : spur_px;
}

class Pruner {
 public:
  Pruner(std::span<GraphNode> nodes, std::span<GraphEdge> edges, const LineWidthView& line_widths, int spur_px)
      : nodes_(nodes), edges_(edges), line_widths_(line_widths), spur_px_(spur_px) {}

  /// From a free end along `edge` toward `node`: marks the chain when it is a spur. Degrees stay as they are, so that
  /// both prongs of a fork at a line's end are judged alike.
  void judge(std::uint16_t edge, std::uint16_t node) {
    if (!is_short(edge, node, false)) return;
    is_short(edge, node, true);
  }

  std::size_t compact() {
    std::size_t kept = 0;
    for (const GraphEdge& e : edges_) {
      if (e.point_count != 0) edges_[kept++] = e;
    }
    for (GraphNode& n : nodes_) n.degree = 0;
    for (std::size_t i = 0; i < kept; ++i) {
      for (const std::uint16_t n : {edges_[i].node_a, edges_[i].node_b}) {
        if (n != no_node) nodes_[n].edge[nodes_[n].degree++] = static_cast<std::uint16_t>(i);
      }
    }
    return kept;
  }

 private:
  /// Follows the chain through nodes of degree 2. With `mark`, marks its edges on the way (point_count 0).
  bool is_short(std::uint16_t edge, std::uint16_t node, bool mark) {
    int steps = 0;
    for (std::size_t n = 0; n < edges_.size(); ++n) {   // no edge twice
      if (edges_[edge].point_count == 0) return false;  // marked from its other end
      steps += static_cast<int>(edges_[edge].point_count) - 1;
      if (mark) edges_[edge].point_count = 0;
      if (node == no_node) return steps < spur_px_;  // both ends free
      if (!mark && steps >= spur_limit(nodes_[node].at, line_widths_, spur_px_)) return false;
      if (nodes_[node].degree != 2) return true;  // a fork, or an end
      const GraphNode& at = nodes_[node];
      edge = at.edge[0] == edge ? at.edge[1] : at.edge[0];
      const GraphEdge& e = edges_[edge];
      node = e.node_a == node ? e.node_b : e.node_a;
    }
    return false;
  }

  std::span<GraphNode> nodes_;
  std::span<GraphEdge> edges_;
  const LineWidthView& line_widths_;
  int spur_px_;
};

}  // namespace

std::size_t prune_spurs(std::span<GraphNode> nodes, std::span<GraphEdge> edges, const LineWidthView& line_widths,
                        int spur_px) {
  Pruner pruner(nodes, edges, line_widths, spur_px);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const GraphEdge e = edges[i];
    if (e.point_count == 0 || e.node_a == e.node_b) continue;
    const auto edge = static_cast<std::uint16_t>(i);
    if (e.node_b == no_node || nodes[e.node_b].degree == 1) {
      pruner.judge(edge, e.node_a);
    } else if (nodes[e.node_a].degree == 1) {
      pruner.judge(edge, e.node_b);
    }
  }
  return pruner.compact();
}

}  // namespace touchline
