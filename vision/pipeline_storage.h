// SPDX-License-Identifier: Apache-2.0
// The one object that owns all memory of the vision pipeline. Its size is the memory budget.
#pragma once

#include <array>

#include "vision/image/frame.h"
#include "vision/image/hull.h"
#include "vision/pipeline_memory.h"
#include "vision/stage_work.h"

namespace touchline {

/// For working images of up to W x H (983,000 pixels in all, for numbers of 16 bits), frames of up to FrameWidth
/// columns, and a FIFO of Depth frames.
template <int W = 320, int H = 240, int Depth = 4, int FrameWidth = max_frame_width>
class PipelineStorage {
  static_assert(Depth >= 1 && Depth <= max_fifo_depth);

 public:
  [[nodiscard]] PipelineMemory memory() {
    PipelineMemory m;
    m.max_width = W;
    m.max_height = H;
    m.depth = static_cast<std::size_t>(Depth);
    for (std::size_t i = 0; i < m.depth; ++i) m.slots[i] = samples(images_[i]);
    for (std::size_t i = 0; i < stored_mask_count; ++i) m.masks[i] = masks_[i].words;
    mask(m, MaskId::skeleton) = mask(m, MaskId::white);
    mask(m, MaskId::post_colour) = mask(m, MaskId::ground);
    mask(m, MaskId::scratch) = work_.masks.scratch.words;
    m.rays = rays_;
    m.line_widths = line_widths_;
    m.subsample = subsample_memory(subsample_, work_.average);
    m.blob_search = work_.roi.search.memory();
    m.blobs = work_.roi.blobs;
    m.hull = hull_;
    m.hull_scratch = work_.roi.hull;
    m.canny = work_.masks.canny.memory();
    m.thinning = {work_.masks.thinning.columns, work_.masks.scratch.words, work_.masks.thinning.marks};
    m.pieces = work_.pieces.memory();
    m.graph = graph_memory(graph_, work_.graph);
    m.feature_work = &work_.features.work;
    m.edge_done = work_.features.edge_done;
    m.features = &features_;
    return m;
  }

 private:
  using Slot = Yuv420Image<W, H>;
  static Yuv420Samples samples(Slot& slot) { return {slot.y.samples, slot.cb.samples, slot.cr.samples}; }

  static std::span<BitWord>& mask(PipelineMemory& m, MaskId id) { return m.masks[static_cast<std::size_t>(id)]; }

  std::array<Slot, static_cast<std::size_t>(Depth)> images_{};
  std::array<BitImage<W, H>, stored_mask_count> masks_{};
  std::array<Vec3, static_cast<std::size_t>(ray_columns(W)) * static_cast<std::size_t>(ray_rows(H))> rays_{};
  std::array<LineWidth, static_cast<std::size_t>(ray_columns(W) - 1) * static_cast<std::size_t>(ray_rows(H) - 1)>
      line_widths_{};
  SubsampleTables<FrameWidth, W> subsample_{};
  std::array<GridPoint, static_cast<std::size_t>(max_hull_points(H)) + 1> hull_{};
  GraphProducts<W, H> graph_{};
  Features features_{};
  StageWork<W, H, FrameWidth> work_{};
};

// The budget at 320x240.
static_assert(sizeof(PipelineStorage<320, 240, 4>) <= 688 * 1024);
static_assert(sizeof(PipelineStorage<320, 240, 1>) <= 352 * 1024);

}  // namespace touchline
