// SPDX-License-Identifier: Apache-2.0
// Memory of digestion and node graph for working images of up to W x H pixels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "vision/digestion.h"
#include "vision/image/thinning.h"
#include "vision/node_graph.h"
#include "vision/short_pieces.h"
#include "vision/skeleton_index.h"

namespace touchline {

/// Views of all of it; what the stages take.
struct GraphMemory {
  SkeletonIndexMemory index;
  DigestionMemory digestion;
  NodeGraphMemory graph;
  std::span<std::uint8_t> edge_done;  // one an edge: it has been read into a chain
};

template <int W, int H>
struct GraphStorage {
  static constexpr std::size_t area = static_cast<std::size_t>(W) * static_cast<std::size_t>(H);
  // The longest skeletons of field lines seen at 320x240 have about 1,500 pixels; one pixel in 24 is twice that. Only
  // noise has more, and then the rows nearest to the robot are kept.
  static constexpr std::size_t max_pixels = area / 24;
  // Major nodes lie farther apart than the digestion radius, so lines have a node every 8 pixels and forks come on top.
  // A fifth of the pixels is reached by noise alone.
  static constexpr std::size_t max_nodes = max_pixels / 5;
  static constexpr std::size_t max_edges = max_nodes * 3 / 2;            // most nodes have two ways, forks three
  static constexpr std::size_t max_points = max_pixels + 2 * max_edges;  // each pixel once, and both ends of every edge
  static_assert(max_pixels < no_pixel, "pixels are numbered with 16 bits");
  // Before, short pieces of skeleton are looked for in the memory of the node graph.
  static_assert(max_pixels >= 3 * max_open_pieces(W) && max_points >= 4 * max_open_pieces(W), "too few rows");

  std::array<GridPoint, max_pixels> pixels{};
  std::array<std::uint16_t, static_cast<std::size_t>(words_for(W)) * static_cast<std::size_t>(H)> pixels_before{};
  std::array<BitWord, std::max(live_node_words(W, H), thinning_columns_size(W, H))>
      plane{};                                           // live nodes; before that, thinning
  std::array<std::uint16_t, max_pixels> pixel_labels{};  // the forest while digesting, then the node of each pixel
  std::array<std::int32_t, max_pixels> weight{};
  std::array<MajorNode, max_nodes> major_nodes{};
  std::array<PixelIndex, max_pixels> cluster{};
  std::array<std::uint16_t, max_pixels> stack{};
  std::array<std::uint16_t, max_nodes> first_pixel{};
  std::array<std::uint8_t, max_nodes> expanded{};
  std::array<GraphNode, max_nodes> nodes{};
  std::array<GraphEdge, max_edges> edges{};
  std::array<GridPoint, max_points> points{};
  std::array<std::uint8_t, max_edges> edge_done{};

  [[nodiscard]] GraphMemory memory() {
    return {{pixels, pixels_before},
            {{plane.data(), live_node_words(W, H)}, pixel_labels, weight, major_nodes},
            {{plane.data(), words_for(W) * std::size_t{H}},
             pixel_labels,
             cluster,
             stack,
             first_pixel,
             expanded,
             nodes,
             edges,
             points},
            edge_done};
  }
};

}  // namespace touchline
