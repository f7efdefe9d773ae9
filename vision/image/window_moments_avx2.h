// SPDX-License-Identifier: Apache-2.0
// Moments of a window of a mask (moments.h), eight rows at a time. Included by files of kernels for AVX2 and later
// alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/moments.h"

namespace touchline {
namespace {
namespace moments_avx2 {

/// Of the four bits of each half byte; `table` holds the sum of each of the sixteen patterns.
inline __m256i sums_of(__m128i table, __m256i patterns) {
  return _mm256_shuffle_epi8(_mm256_broadcastsi128_si256(table), patterns);
}
/// Of the four bytes of each lane the sum, each times its weight.
inline __m256i weighted(__m256i bytes, __m256i weights) {
  return _mm256_madd_epi16(_mm256_maddubs_epi16(bytes, weights), _mm256_set1_epi16(1));
}
/// The same weights for each lane, of the four bytes whose first pixels are 0, 8, 16 and 24.
inline __m256i byte_weights(int a, int b, int c) {
  return _mm256_set1_epi32((a & 255) | (b & 255) << 8 | (c & 255) << 16);  // 21 pixels reach into no fourth byte
}
inline int sum_of(__m256i v) {
  const __m128i half = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  const __m128i quarter = _mm_add_epi32(half, _mm_unpackhi_epi64(half, half));
  return _mm_cvtsi128_si32(_mm_add_epi32(quarter, _mm_shuffle_epi32(quarter, 1)));
}

/// Eight rows a time. Tables give the number, the sum and the sum of squares of the columns in each byte, which
/// then move to the window's middle: (x + o)^2 = x^2 + 2 o x + o^2.
inline void window_moments(const MomentWindow& w, Moments& m) {
  const __m128i count = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m128i low_x = _mm_setr_epi8(0, 0, 1, 1, 2, 2, 3, 3, 3, 3, 4, 4, 5, 5, 6, 6);
  const __m128i low_xx = _mm_setr_epi8(0, 0, 1, 1, 4, 4, 5, 5, 9, 9, 10, 10, 13, 13, 14, 14);
  const __m128i high_x = _mm_setr_epi8(0, 4, 5, 9, 6, 10, 11, 15, 7, 11, 12, 16, 13, 17, 18, 22);
  const __m128i high_xx = _mm_setr_epi8(0, 16, 25, 41, 36, 52, 61, 77, 49, 65, 74, 90, 85, 101, 110, 126);
  const int rows = 2 * w.radius + 1;
  const int a = -(w.columns / 2), b = w.columns > 8 ? a + 8 : 0, c = w.columns > 16 ? a + 16 : 0;  // first columns
  const __m256i once = _mm256_set1_epi8(1);
  const __m256i first = byte_weights(a, b, c);
  const __m256i twice = byte_weights(2 * a, 2 * b, 2 * c);
  const __m256i square = byte_weights(a * a, b * b, c * c);
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i at = _mm256_mullo_epi32(lane, _mm256_set1_epi32(static_cast<int>(w.stride)));
  const __m256i inside = _mm256_set1_epi32((1 << w.columns) - 1);
  const __m256i half_byte = _mm256_set1_epi8(15);
  __m256i n = _mm256_setzero_si256();
  __m256i x = n, y = n, xx = n, xy = n, yy = n;
  for (int row = 0; row < rows; row += 8) {
    const auto* from = reinterpret_cast<const int*>(w.bytes + row * w.stride);
    const __m256i valid = _mm256_cmpgt_epi32(_mm256_set1_epi32(rows - row), lane);
    const __m256i words = _mm256_mask_i32gather_epi32(_mm256_setzero_si256(), from, at, valid, 1);
    const __m256i bits = _mm256_and_si256(_mm256_srl_epi32(words, _mm_cvtsi32_si128(w.shift)), inside);
    const __m256i low = _mm256_and_si256(bits, half_byte);
    const __m256i high = _mm256_and_si256(_mm256_srli_epi16(bits, 4), half_byte);
    const __m256i byte_n = _mm256_add_epi8(sums_of(count, low), sums_of(count, high));
    const __m256i byte_x = _mm256_add_epi8(sums_of(low_x, low), sums_of(high_x, high));
    const __m256i byte_xx = _mm256_add_epi8(sums_of(low_xx, low), sums_of(high_xx, high));
    const __m256i row_n = weighted(byte_n, once);
    const __m256i row_x = _mm256_add_epi32(weighted(byte_x, once), weighted(byte_n, first));
    const __m256i row_xx =
        _mm256_add_epi32(_mm256_add_epi32(weighted(byte_xx, once), weighted(byte_x, twice)), weighted(byte_n, square));
    const __m256i dy = _mm256_add_epi32(lane, _mm256_set1_epi32(row - w.radius));
    const __m256i row_y = _mm256_mullo_epi32(row_n, dy);
    n = _mm256_add_epi32(n, row_n);
    x = _mm256_add_epi32(x, row_x);
    y = _mm256_add_epi32(y, row_y);
    xx = _mm256_add_epi32(xx, row_xx);
    xy = _mm256_add_epi32(xy, _mm256_mullo_epi32(row_x, dy));
    yy = _mm256_add_epi32(yy, _mm256_mullo_epi32(row_y, dy));
  }
  m.n = sum_of(n);
  m.x = sum_of(x);
  m.y = sum_of(y);
  m.xx = sum_of(xx);
  m.xy = sum_of(xy);
  m.yy = sum_of(yy);
}

}  // namespace moments_avx2
}  // namespace
}  // namespace touchline
