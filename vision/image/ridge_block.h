// SPDX-License-Identifier: Apache-2.0
// Which pixels of a block of 8x8 stand out in luma from what lies some pixels to both sides: the part of the ridge
// search that looks at every pixel. Colour and geometry are the caller's.
#pragma once

#include <cstddef>
#include <cstdint>

namespace touchline {

inline constexpr int ridge_block_px = 8;
inline constexpr int max_ridge_reach_px = 10;
inline constexpr int max_ridge_looks = 3;  // along the row, and as many along the column

struct RidgeBlock {
  const std::uint8_t* luma = nullptr;  // of the image
  std::ptrdiff_t stride = 0;
  int width = 0, height = 0;  // of the image
  int x0 = 0, y0 = 0;         // of the block
  /// Steps to both sides, 1..max_ridge_reach_px.
  int row_reach[max_ridge_looks] = {}, column_reach[max_ridge_looks] = {};
  int row_looks = 0, column_looks = 0;
  /// Lumas are sums of weight 4: the pixel and its two neighbours across the look. It stands out when it is larger than
  /// the larger of both sides by a sixteenth of that and by the margin. Margins 0 to 8,192, strong at least weak.
  std::int16_t weak_margin = 0, strong_margin = 0;
};

/// Bit 8 y + x of each look. Pixels whose neighbours or sides lie outside the image mean nothing.
struct RidgeBits {
  std::uint64_t row_weak[max_ridge_looks] = {}, row_strong[max_ridge_looks] = {};
  std::uint64_t column_weak[max_ridge_looks] = {}, column_strong[max_ridge_looks] = {};
};

}  // namespace touchline
