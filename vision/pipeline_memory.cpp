// SPDX-License-Identifier: Apache-2.0
#include "vision/pipeline_memory.h"

namespace touchline {
namespace {

Yuv420View image_view(const Yuv420Samples& samples, int width, int height) {
  const int chroma_width = (width + 1) / 2;
  const int chroma_height = (height + 1) / 2;
  return {{samples.y.data(), width, height, width},
          {samples.cb.data(), chroma_width, chroma_height, chroma_width},
          {samples.cr.data(), chroma_width, chroma_height, chroma_width}};
}

}  // namespace

bool make_views(const PipelineMemory& memory, int width, int height, PipelineViews& views) {
  if (width < 16 || height < 16 || width > memory.max_width || height > memory.max_height) return false;
  views.width = width;
  views.height = height;
  for (std::size_t i = 0; i < memory.depth; ++i) views.slots[i] = image_view(memory.slots[i], width, height);
  for (std::size_t i = 0; i < mask_count; ++i) {
    views.masks[i] = BitView{memory.masks[i].data(), width, height, words_for(width)};
  }
  views.rays = {memory.rays, ray_columns(width), ray_rows(height)};
  const int blocks = ray_columns(width) - 1;
  views.line_widths = {memory.line_widths.data(), blocks, ray_rows(height) - 1, blocks};
  return true;
}

}  // namespace touchline
