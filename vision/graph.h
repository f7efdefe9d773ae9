// SPDX-License-Identifier: Apache-2.0
// The node graph of a skeleton (paper section IV-E, Algorithm 2). Data types; built by node_graph.h.
#pragma once

#include <cstdint>
#include <span>

#include "vision/image/grid_point.h"

namespace touchline {

/// A major node that digestion left alive (Algorithm 1).
struct MajorNode {
  GridPoint at;
  std::int32_t weight = 0;  // its own and all that it digested
};

inline constexpr int max_degree = 8;  // a pixel has eight neighbours
struct GraphNode {
  GridPoint at;
  std::uint8_t degree = 0;              // edge ends that meet here; a loop counts twice
  std::uint16_t edge[max_degree] = {};  // indices of those edges
};

/// A stretch of skeleton between two nodes (or from a node to a free end: then node_b is no_node).
inline constexpr std::uint16_t no_node = 0xFFFF;
struct GraphEdge {
  std::uint16_t node_a = 0;  // at first, so that a static storage takes no room in flash
  std::uint16_t node_b = 0;
  std::uint16_t first_point = 0;  // into NodeGraphView::points, from node_a to node_b, both ends included
  std::uint16_t point_count = 0;
};

struct NodeGraphView {
  std::span<const GraphNode> nodes;
  std::span<const GraphEdge> edges;
  std::span<const GridPoint> points;  // the polylines of all edges
  [[nodiscard]] std::span<const GridPoint> polyline(const GraphEdge& e) const {
    return points.subspan(e.first_point, e.point_count);
  }
};

}  // namespace touchline
