// SPDX-License-Identifier: Apache-2.0
// All memory that the chain works in, as spans at their full capacity, and the views of it at one working size.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vision/features.h"
#include "vision/graph.h"
#include "vision/graph_storage.h"
#include "vision/image/bit_image.h"
#include "vision/image/blobs.h"
#include "vision/image/canny.h"
#include "vision/image/frame_fifo.h"
#include "vision/image/subsample.h"
#include "vision/image/thinning.h"
#include "vision/junctions.h"
#include "vision/line_width_table.h"
#include "vision/ray_grid.h"
#include "vision/short_pieces.h"

namespace touchline {

/// The masks of the chain, each of one bit a working pixel.
enum class MaskId : std::uint8_t {
  seen,         // inside the image circle and not the robot itself; made once
  ground,       // sees the carpet
  green,        // the carpet's colour, before erosion
  clean_green,  // after erosion and dilation
  white,        // no colour
  field,        // the largest blob
  roi,          // its hull
  candidates,   // white search united with Canny
  line_mask,
  edges,        // Canny's, before the rule of white and green
  skeleton,     // in the memory of white, which was looked at for the last time before
  post_colour,  // the colour of goal posts; likewise in that of ground
  scratch,      // in the memory that stages work in, so no stage finds it as another left it
  count,
};
inline constexpr std::size_t mask_count = static_cast<std::size_t>(MaskId::count);
inline constexpr std::size_t stored_mask_count = static_cast<std::size_t>(MaskId::skeleton);  // the rest share memory

/// Samples of one working image at full capacity.
struct Yuv420Samples {
  std::span<std::uint8_t> y, cb, cr;
};

struct PipelineMemory {
  int max_width = 0;
  int max_height = 0;
  std::size_t depth = 0;  // slots that are there
  std::array<Yuv420Samples, max_fifo_depth> slots;
  SubsampleMemory subsample;
  std::array<std::span<BitWord>, mask_count> masks;
  std::span<Vec3> rays;
  std::span<LineWidth> line_widths;
  BlobMemory blob_search;
  std::span<Blob> blobs;
  std::span<GridPoint> hull;          // two a row, and one
  std::span<GridPoint> hull_scratch;  // likewise
  CannyMemory canny;
  ThinningMemory thinning;
  PieceMemory pieces;
  GraphMemory graph;
  FeatureWork* feature_work = nullptr;
  std::span<std::uint8_t> edge_done;  // one an edge of the graph
  Features* features = nullptr;
};

/// The same memory at the working size that was configured.
struct PipelineViews {
  int width = 0;
  int height = 0;
  std::array<Yuv420View, max_fifo_depth> slots;
  std::array<BitView, mask_count> masks;
  RayGridView rays;
  ImageView<LineWidth> line_widths;

  [[nodiscard]] const BitView& mask(MaskId id) const { return masks[static_cast<std::size_t>(id)]; }
};

/// False when the working size is larger than the memory.
bool make_views(const PipelineMemory& memory, int width, int height, PipelineViews& views);

}  // namespace touchline
