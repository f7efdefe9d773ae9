// SPDX-License-Identifier: Apache-2.0
// The node graph of a skeleton (paper section IV-E, Algorithm 2): which nodes are joined by a stretch of line, and
// along which pixels.
//
// Nodes are the major nodes of digestion, and besides them every fork of the skeleton (a cluster of pixels with three
// ways or more): digestion may put the major node some pixels beside the fork it stands for, or one for two forks that
// are close together, and the degree has to be counted where the ways part. A closed loop that digestion left without a
// major node gets one. Between nodes every pixel has two ways, so a walk needs no choice; the depth-first order is
// kept by an explicit stack of nodes.
//
// Spurs (chains with a free end that leave a fork and are short) are taken off before degrees are counted. Thinning
// leaves them at the corners of wide lines, so the limit grows with the width of a line at that place.
#pragma once

#include <cstdint>
#include <span>

#include "vision/graph.h"
#include "vision/line_width_table.h"
#include "vision/skeleton_index.h"

namespace touchline {

struct NodeGraphParameters {
  int spur_px = 6;  // a chain with a free end shorter than this is a spur
};

/// Working memory and product. The sizes of nodes, edges and points are capacities.
struct NodeGraphMemory {
  std::span<BitWord> open;               // as the mask: pixels of lines that no edge has taken
  std::span<std::uint16_t> node_of;      // one a skeleton pixel
  std::span<PixelIndex> cluster;         // one a skeleton pixel: the pixels of the forks, fork by fork
  std::span<std::uint16_t> stack;        // one a skeleton pixel; holds pixels, then nodes
  std::span<std::uint16_t> first_pixel;  // one a node: where its pixels begin in `cluster`
  std::span<BitWord> expanded;           // a bit a node: its ways have been walked
  std::span<GraphNode> nodes;            // at most 65,534
  std::span<GraphEdge> edges;            // at most 65,534
  std::span<GridPoint> points;           // at most 65,535
};

struct NodeGraphResult {
  NodeGraphView graph;
  int spurs = 0;           // edges taken off as spurs
  int dropped_nodes = 0;   // nodes without room: their pixels are taken for line
  int dropped_edges = 0;   // edges without room, in the list or at a node that already has max_degree
  int dropped_points = 0;  // points of those edges
};

/// `line_widths` may be empty (data == nullptr): then spur_px alone is the limit.
NodeGraphResult build_node_graph(const SkeletonIndex& skeleton, std::span<const MajorNode> major_nodes,
                                 const LineWidthView& line_widths, const NodeGraphParameters& parameters,
                                 const NodeGraphMemory& memory);

}  // namespace touchline
