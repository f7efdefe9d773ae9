// SPDX-License-Identifier: Apache-2.0
// Digestion: which skeleton pixels stand for a piece of line (paper section IV-D, Algorithm 1), on a disjoint-set
// forest. Every skeleton pixel is a node with a weight by its number of neighbours; in raster order each pixel lets the
// heaviest node within the digestion radius eat all others there. Who is left is a major node.
//
// The matrix form visits every pixel of the disc. Here a set is a live node with all that it has eaten, its weight is
// kept at the root, and only live roots are gathered: from a bit map, 64 pixels at once under a mask of the disc. So
// the cost follows the live nodes in the disc, hardly its area; the major nodes are those of the matrix form.
#pragma once

#include <cstdint>
#include <span>

#include "vision/graph.h"
#include "vision/skeleton_index.h"

namespace touchline {

struct DigestionParameters {
  int radius_px = 5;                                          // Euclidean, working pixels, >= 0
  int low_weight = 1, medium_weight = 10, high_weight = 100;  // of 2, 3, 4 or more neighbours; 0..32,767
};

/// The live nodes are kept as bits in strips of 16 columns, row after row, and in an empty strip beside them.
constexpr int rows_of_strip(int height) { return (height + 3) / 4 * 4; }
constexpr std::size_t live_node_words(int width, int height) {
  return static_cast<std::size_t>((width + 15) / 16 + 1) * static_cast<std::size_t>(rows_of_strip(height) / 4);
}

/// Working memory and product.
struct DigestionMemory {
  std::span<BitWord> live;         // live_node_words(width, height)
  std::span<PixelIndex> parent;    // one a skeleton pixel: the forest
  std::span<std::int32_t> weight;  // one a skeleton pixel: 0, or of the whole set at a live root
  std::span<MajorNode> major_nodes;
};

struct DigestionResult {
  std::span<const MajorNode> major_nodes;  // in raster order
  int dropped = 0;                         // major nodes without room
};

/// Runs Algorithm 1 on the numbered skeleton. After it, digestion_root() tells which node ate a pixel.
DigestionResult digest(const SkeletonIndex& skeleton, const DigestionParameters& parameters,
                       const DigestionMemory& memory);

/// The pixel whose set `pixel` belongs to: a major node, or itself when nobody ate it. Shortens the path on its way.
PixelIndex digestion_root(std::span<PixelIndex> parent, PixelIndex pixel);

}  // namespace touchline
