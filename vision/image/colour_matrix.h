// SPDX-License-Identifier: Apache-2.0
// From three camera channels to full-range YCbCr: integer matrices with 14-bit coefficients (BT.601, JPEG convention).
#pragma once

#include <cstdint>

#include "vision/image/frame.h"

namespace touchline {

inline constexpr int colour_bits = 14;

/// result = (a c0 + b c1 + c c2 + offset) / 2^14, rounded to nearest.
struct ColourRow {
  std::int16_t a = 0, b = 0, c = 0;
  std::int32_t offset = 0;
};
struct ColourMatrix {
  ColourRow y, cb, cr;
};

/// For the three channels of a row that unpack_row() made.
constexpr ColourMatrix colour_matrix(PixelFormat format) {
  constexpr std::int32_t middle = 128 << colour_bits;
  if (format == PixelFormat::yuyv) {
    // Limited range to full: Y = 255/219 (y - 16), C = 128 + 255/224 (c - 128).
    constexpr std::int16_t luma = 19077;
    constexpr std::int16_t chroma = 18651;
    constexpr std::int32_t chroma_offset = middle - 128 * chroma;
    return {{luma, 0, 0, -16 * luma}, {0, chroma, 0, chroma_offset}, {0, 0, chroma, chroma_offset}};
  }
  if (format == PixelFormat::bgr24) {
    return {{1868, 9617, 4899, 0}, {8192, -5427, -2765, middle}, {-1332, -6860, 8192, middle}};
  }
  return {{4899, 9617, 1868, 0}, {-2765, -5427, 8192, middle}, {8192, -6860, -1332, middle}};
}

}  // namespace touchline
