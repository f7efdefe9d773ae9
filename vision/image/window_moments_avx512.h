// SPDX-License-Identifier: Apache-2.0
// Moments of a window of a mask (moments.h), sixteen rows at a time; the tables are those of AVX2's. Included by files
// of kernels for AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/moments.h"

namespace touchline {
namespace {
namespace moments_avx512 {

/// Of the four bits of each half byte; `table` holds the sum of each of the sixteen patterns.
[[gnu::always_inline]] inline __m512i sums_of(__m128i low_table, __m512i low, __m128i high_table, __m512i high) {
  return _mm512_add_epi8(_mm512_shuffle_epi8(_mm512_broadcast_i32x4(low_table), low),
                         _mm512_shuffle_epi8(_mm512_broadcast_i32x4(high_table), high));
}
/// The same weights for each lane, of the four bytes whose first pixels are 0, 8, 16 and 24.
[[gnu::always_inline]] inline __m512i byte_weights(int a, int b, int c) {
  return _mm512_set1_epi32((a & 255) | (b & 255) << 8 | (c & 255) << 16);  // 21 pixels reach into no fourth byte
}
/// a in the lower 16 bits of each lane, b in the upper ones.
[[gnu::always_inline]] inline __m512i both(__m512i a, __m512i b) {
  return _mm512_mask_blend_epi16(0xAAAAAAAAU, a, _mm512_slli_epi32(b, 16));
}

/// All six sums of 21 x 21 pixels around their middle fit into 16 bits: the largest is 21 * 770.
inline void window_moments(const MomentWindow& w, Moments& m) {
  const __m128i count = _mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4);
  const __m128i low_x = _mm_setr_epi8(0, 0, 1, 1, 2, 2, 3, 3, 3, 3, 4, 4, 5, 5, 6, 6);
  const __m128i low_xx = _mm_setr_epi8(0, 0, 1, 1, 4, 4, 5, 5, 9, 9, 10, 10, 13, 13, 14, 14);
  const __m128i high_x = _mm_setr_epi8(0, 4, 5, 9, 6, 10, 11, 15, 7, 11, 12, 16, 13, 17, 18, 22);
  const __m128i high_xx = _mm_setr_epi8(0, 16, 25, 41, 36, 52, 61, 77, 49, 65, 74, 90, 85, 101, 110, 126);
  const int size = 2 * w.radius + 1;
  const int a = -w.radius, b = size > 8 ? 8 - w.radius : 0, c = size > 16 ? 16 - w.radius : 0;  // first columns
  const __m512i once = _mm512_set1_epi8(1);
  const __m512i first = byte_weights(a, b, c);
  const __m512i twice = byte_weights(2 * a, 2 * b, 2 * c);
  const __m512i square = byte_weights(a * a, b * b, c * c);
  const __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  const __m512i at = _mm512_mullo_epi32(lane, _mm512_set1_epi32(static_cast<int>(w.stride)));
  const __m512i inside = _mm512_set1_epi32((1 << size) - 1);
  const __m512i half_byte = _mm512_set1_epi8(15);
  const __m512i zero = _mm512_setzero_si512();
  __m512i n = zero, x = zero, y = zero, xx = zero, xy = zero, yy = zero;
  for (int row = 0; row < size; row += 16) {
    const int rows = size - row;
    const auto valid = static_cast<__mmask16>(rows >= 16 ? 0xFFFF : (1 << rows) - 1);
    const __m512i words = _mm512_mask_i32gather_epi32(zero, valid, at, w.bytes + row * w.stride, 1);
    const __m512i bits = _mm512_and_si512(_mm512_srl_epi32(words, _mm_cvtsi32_si128(w.shift)), inside);
    const __m512i low = _mm512_and_si512(bits, half_byte);
    const __m512i high = _mm512_and_si512(_mm512_srli_epi16(bits, 4), half_byte);
    const __m512i byte_n = sums_of(count, low, count, high);
    const __m512i byte_x = sums_of(low_x, low, high_x, high);
    const __m512i byte_xx = sums_of(low_xx, low, high_xx, high);
    // Column x of a byte is x + o from the middle: (x + o)^2 = x^2 + 2 o x + o^2.
    const __m512i row_n = _mm512_dpbusd_epi32(zero, byte_n, once);
    const __m512i row_x = _mm512_dpbusd_epi32(_mm512_dpbusd_epi32(zero, byte_x, once), byte_n, first);
    xx =
        _mm512_dpbusd_epi32(_mm512_dpbusd_epi32(_mm512_dpbusd_epi32(xx, byte_xx, once), byte_x, twice), byte_n, square);
    // Products of the lower 16 bits: the upper ones of dy are zero.
    const __m512i dy =
        _mm512_and_si512(_mm512_add_epi32(lane, _mm512_set1_epi32(row - w.radius)), _mm512_set1_epi32(0xFFFF));
    n = _mm512_add_epi32(n, row_n);
    x = _mm512_add_epi32(x, row_x);
    y = _mm512_dpwssd_epi32(y, row_n, dy);
    xy = _mm512_dpwssd_epi32(xy, row_x, dy);
    yy = _mm512_dpwssd_epi32(yy, row_n, _mm512_madd_epi16(dy, dy));
  }
  const __m512i nx = both(n, x), yx = both(y, xx), xyy = both(xy, yy);
  const auto halved = [](__m512i v) __attribute__((always_inline)) {
    const __m256i half = _mm256_add_epi16(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64(v, 1));
    return _mm_add_epi16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
  };
  const __m128i p = halved(nx), q = halved(yx), r = halved(xyy);
  const __m128i pq = _mm_add_epi16(_mm_unpacklo_epi32(p, q), _mm_unpackhi_epi32(p, q));
  const __m128i rr = _mm_add_epi16(r, _mm_unpackhi_epi64(r, r));
  const __m128i four_sums = _mm_add_epi16(pq, _mm_unpackhi_epi64(pq, pq));
  const __m128i two_sums = _mm_add_epi16(rr, _mm_shuffle_epi32(rr, 1));
  const auto four = static_cast<std::uint64_t>(_mm_cvtsi128_si64(four_sums));
  const auto two = static_cast<std::uint32_t>(_mm_cvtsi128_si32(two_sums));
  m.n = static_cast<std::int16_t>(four);
  m.x = static_cast<std::int16_t>(four >> 16);
  m.y = static_cast<std::int16_t>(four >> 32);
  m.xx = static_cast<std::int16_t>(four >> 48);
  m.xy = static_cast<std::int16_t>(two);
  m.yy = static_cast<std::int16_t>(two >> 16);
}

}  // namespace moments_avx512
}  // namespace
}  // namespace touchline
