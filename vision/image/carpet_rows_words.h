// SPDX-License-Identifier: Apache-2.0
// The loops of carpet_rows.h for processors without vector registers: sample by sample, and only those of the mask.
#pragma once

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/carpet_rows.h"
#include "vision/image/hsv.h"

namespace touchline {
namespace {
namespace carpet_words {

struct Sample {
  std::int32_t luma, cb, cr;  // chroma as differences from grey
  int x;                      // pixel
  bool inner;                 // the pixels to the left and to the right are carpet's, too
};

inline std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

template <typename Visit>
void for_each_sample(const CarpetRow& row, Visit visit) {
  for (int i = 0; i < words_for(row.width); ++i) {
    const BitWord inner = row.around[i] << 1 & row.around[i] >> 1;
    for_each_bit(row.mask[i] & CarpetRow::samples, [&](int bit) {
      const int x = i * bits_per_word + bit;
      visit(Sample{row.y[x], row.cb[x / 2] - 128, row.cr[x / 2] - 128, x, ((inner >> bit) & 1U) != 0});
    });
  }
}

inline void count_colours(const CarpetRow& row, const HsvRange& gate, CarpetColours& colours) {
  for_each_sample(row, [&](const Sample& s) {
    const Hsv hsv = hsv_from_ycbcr(static_cast<std::uint8_t>(s.luma), static_cast<std::uint8_t>(s.cb + 128),
                                   static_cast<std::uint8_t>(s.cr + 128));
    if (!in_range(hsv, gate)) return;
    ++colours.hues[hsv.hue];
    ++colours.saturations[hsv.saturation];
    ++colours.samples;
  });
}

inline void sum_chroma(const CarpetRow& row, ChromaSums& sums) {
  for_each_sample(row, [&](const Sample& s) {
    sums.cb += s.cb;
    sums.cr += s.cr;
    ++sums.samples;
  });
}

inline void count_ratios(const CarpetRow& row, const ChromaAxis& axis, CarpetRatios& ratios) {
  for_each_sample(row, [&](const Sample& s) {
    const std::int32_t luma = std::max<std::int32_t>(s.luma, 1);
    const std::int32_t along = s.cb * axis.cb + s.cr * axis.cr;  // 2^-8
    const std::int32_t chroma = (magnitude(s.cb) + magnitude(s.cr)) * 256;
    ++ratios.greenness[std::clamp<std::int32_t>(along / luma, 0, 255)];
    ++ratios.chroma[std::min<std::int32_t>(chroma / luma, 255)];
    ++ratios.lumas[s.luma];
    if (s.inner) {
      const std::uint8_t* y = row.y + s.x;
      ratios.roughness += std::min<std::int32_t>(magnitude(2 * y[0] - y[-1] - y[1]), 32);
      ++ratios.rough_samples;
    }
  });
}

inline CarpetKernels kernels() { return {count_colours, sum_chroma, count_ratios}; }

}  // namespace carpet_words
}  // namespace
}  // namespace touchline
