// SPDX-License-Identifier: Apache-2.0
// The one object that owns all memory of the vision pipeline. Its size is the memory budget.
#pragma once

#include <array>

#include "vision/image/frame.h"
#include "vision/image/hull.h"
#include "vision/pipeline_memory.h"

namespace touchline {

/// For working images of up to W x H, frames of up to FrameWidth columns, and a FIFO of Depth frames.
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
    m.subsample = subsample_.memory();
    for (std::size_t i = 0; i < stored_masks; ++i) m.masks[i] = masks_[i].words;
    // The skeleton is made after white was last looked at.
    m.masks[static_cast<std::size_t>(MaskId::skeleton)] = m.masks[static_cast<std::size_t>(MaskId::white)];
    m.rays = rays_;
    m.line_widths = line_widths_;
    m.thinning = {graph_.plane, masks_[static_cast<std::size_t>(MaskId::scratch)].words, thinning_marks_};
    m.blob_search = blob_search_.memory();
    m.blobs = blobs_;
    m.hull = hull_;
    m.hull_scratch = hull_scratch_;
    m.canny = {subsample_.scratch};  // frames are subsampled before their edges are looked for
    m.graph = graph_.memory();
    m.feature_work = &feature_work_;
    m.features = &features_;
    return m;
  }

 private:
  using Slot = Yuv420Image<W, H>;
  static Yuv420Samples samples(Slot& slot) { return {slot.y.samples, slot.cb.samples, slot.cr.samples}; }

  std::array<Slot, static_cast<std::size_t>(Depth)> images_{};
  SubsampleStorage<FrameWidth, W, static_cast<std::size_t>(canny_rows* canny_row_stride(W))> subsample_{};
  static constexpr std::size_t stored_masks = mask_count - 1;
  static_assert(static_cast<std::size_t>(MaskId::skeleton) == stored_masks, "the last one shares its memory");
  std::array<BitImage<W, H>, stored_masks> masks_{};
  std::array<Vec3, static_cast<std::size_t>(ray_columns(W)) * static_cast<std::size_t>(ray_rows(H))> rays_{};
  std::array<LineWidth, static_cast<std::size_t>(ray_columns(W) - 1) * static_cast<std::size_t>(ray_rows(H) - 1)>
      line_widths_{};
  std::array<BitWord, thinning_marks_size(W, H)> thinning_marks_{};
  BlobStorage<W> blob_search_{};
  std::array<Blob, 64> blobs_{};  // pieces of green, largest first kept: the field, boards, chairs, clothes
  std::array<GridPoint, static_cast<std::size_t>(max_hull_points(H)) + 1> hull_{};
  std::array<GridPoint, static_cast<std::size_t>(max_hull_points(H)) + 1> hull_scratch_{};
  GraphStorage<W, H> graph_{};
  FeatureWork feature_work_{};
  Features features_{};
};

// The budget at 320x240.
static_assert(sizeof(PipelineStorage<320, 240, 4>) <= 804 * 1024);
static_assert(sizeof(PipelineStorage<320, 240, 1>) <= 480 * 1024);

}  // namespace touchline
