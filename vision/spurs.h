// SPDX-License-Identifier: Apache-2.0
// Takes spurs off a node graph: chains of edges that leave a fork and end free after a few pixels. Thinning makes them
// from bumps on the edge of a line and from the corners of wide lines. Pieces of skeleton shorter than that which hang
// on nothing go as well.
#pragma once

#include <cstddef>
#include <span>

#include "vision/graph.h"
#include "vision/line_width_table.h"

namespace touchline {

/// Removes spurs from `edges` (keeping the order of the rest) and counts the degrees of `nodes` anew. Returns how many
/// edges are left. A chain is a spur when it has fewer steps than spur_px, or than three quarters of a line's width
/// where it begins: the medial axis of a line reaches 0.7 widths into its corners. `line_widths` may be empty.
std::size_t prune_spurs(std::span<GraphNode> nodes, std::span<GraphEdge> edges, const LineWidthView& line_widths,
                        int spur_px);

}  // namespace touchline
