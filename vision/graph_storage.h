// SPDX-License-Identifier: Apache-2.0
// Memory of digestion and node graph for working images of up to W x H pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vision/digestion.h"
#include "vision/node_graph.h"
#include "vision/skeleton_index.h"

namespace touchline {

/// Views of all of it; what the stages take.
struct GraphMemory {
  SkeletonIndexMemory index;
  DigestionMemory digestion;
  NodeGraphMemory graph;
};

/// How many there may be of each.
template <int W, int H>
struct GraphCapacity {
  static constexpr std::size_t area = std::size_t{W} * std::size_t{H};
  // The longest skeletons of field lines seen at 320x240 have about 1,500 pixels; one pixel in 24 is twice that. Only
  // noise has more, and then the rows nearest to the robot are kept.
  static constexpr std::size_t pixels = area / 24;
  // Major nodes lie farther apart than the digestion radius, so lines have a node every 8 pixels and forks come on top.
  // A fifth of the pixels is reached by noise alone.
  static constexpr std::size_t nodes = pixels / 5;
  static constexpr std::size_t edges = nodes * 3 / 2;        // most nodes have two ways, forks three
  static constexpr std::size_t points = pixels + 2 * edges;  // each pixel once, and both ends of every edge
  static_assert(pixels < no_pixel && points <= 65'535, "they are numbered with 16 bits");
};

/// What stays until the next frame.
template <int W, int H>
struct GraphProducts {
  using Capacity = GraphCapacity<W, H>;
  std::array<MajorNode, Capacity::nodes> major_nodes{};
  std::array<GraphNode, Capacity::nodes> nodes{};
  std::array<GraphEdge, Capacity::edges> edges{};
  std::array<GridPoint, Capacity::points> points{};
};

/// What only digestion and node graph look at.
template <int W, int H>
struct GraphWork {
  using Capacity = GraphCapacity<W, H>;
  struct Digestion {
    std::array<BitWord, live_node_words(W, H)> live{};
    std::array<std::int32_t, Capacity::pixels> weight{};
  };
  struct Walk {
    std::array<BitWord, std::size_t{words_for(W)} * std::size_t{H}> open{};
    std::array<PixelIndex, Capacity::pixels> cluster{};
    std::array<std::uint16_t, Capacity::pixels> stack{};
    std::array<std::uint16_t, Capacity::nodes> first_pixel{};
    std::array<BitWord, std::size_t{words_for(int{Capacity::nodes})}> expanded{};
  };
  std::array<GridPoint, Capacity::pixels> pixels{};
  std::array<std::uint16_t, std::size_t{words_for(W)} * std::size_t{H}> pixels_before{};
  std::array<std::uint16_t, Capacity::pixels> labels{};  // the forest while digesting, then the node of each pixel
  union {
    Digestion digestion;
    Walk walk;  // afterwards
  };
  constexpr GraphWork() : digestion() {}
};

template <int W, int H>
GraphMemory graph_memory(GraphProducts<W, H>& products, GraphWork<W, H>& work) {
  return {{work.pixels, work.pixels_before},
          {work.digestion.live, work.labels, work.digestion.weight, products.major_nodes},
          {work.walk.open, work.labels, work.walk.cluster, work.walk.stack, work.walk.first_pixel, work.walk.expanded,
           products.nodes, products.edges, products.points}};
}

template <int W, int H>
struct GraphStorage {
  GraphProducts<W, H> products;
  GraphWork<W, H> work;
  [[nodiscard]] GraphMemory memory() { return graph_memory(products, work); }
};

}  // namespace touchline
