// SPDX-License-Identifier: Apache-2.0
// What the carpet's colour is made of (green.h), row by row: histograms over every second chroma sample. The numbers
// that the loops need; what they mean is told there.
#pragma once

#include <cstdint>

#include "vision/image/hsv_range.h"

namespace touchline {

/// A row of chroma and the upper row of luma that it belongs to. Its samples are pixels 2, 6, 10, ... of the mask:
/// never a word's first or last, so that both neighbours are in the same word.
struct CarpetRow {
  static constexpr std::uint64_t samples = 0x4444444444444444U;

  const std::uint8_t* y = nullptr;
  const std::uint8_t* cb = nullptr;  // (width + 1) / 2
  const std::uint8_t* cr = nullptr;
  const std::uint64_t* mask = nullptr;
  const std::uint64_t* around = nullptr;  // holds the mask: where luma is carpet's, too
  int width = 0;
};

using Histogram = std::int32_t[256];

/// Of the samples in the gate.
struct CarpetColours {
  Histogram hues{};
  Histogram saturations{};
  std::int32_t samples = 0;
};

/// Chroma as differences from grey.
struct ChromaSums {
  std::int32_t cb = 0, cr = 0;
  std::int32_t samples = 0;
};

struct ChromaAxis {
  std::int32_t cb = 0, cr = 0;  // 2^-8, |cb| and |cr| up to 256
};

/// Ratios to luma, 2^-8, and luma itself.
struct CarpetRatios {
  Histogram greenness{};  // of chroma along the axis
  Histogram chroma{};     // of |cb| + |cr|
  Histogram lumas{};
  std::int32_t roughness = 0;  // sum of |2 a - b - c| of a sample and its neighbours, each at most 32
  std::int32_t rough_samples = 0;
};

/// Each adds a row.
struct CarpetKernels {
  void (*count_colours)(const CarpetRow& row, const HsvRange& gate, CarpetColours& colours) = nullptr;
  void (*sum_chroma)(const CarpetRow& row, ChromaSums& sums) = nullptr;
  void (*count_ratios)(const CarpetRow& row, const ChromaAxis& axis, CarpetRatios& ratios) = nullptr;
};

}  // namespace touchline
