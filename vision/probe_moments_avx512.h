// SPDX-License-Identifier: Apache-2.0
// Moments of sixteen windows of a mask at the same time (image/moments.h), a row of each after the other. Included by
// the file of kernels for AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/line_probe.h"

namespace touchline {
namespace {
namespace probe_avx512 {

enum : int { pattern_px = 7 };  // three patterns are the 21 pixels of the widest row

/// Of each pattern of seven pixels the number, the sum of their columns and that of the columns' squares.
struct Sums {
  alignas(64) std::uint8_t n[128] = {}, x[128] = {}, xx[128] = {};
};
constexpr Sums make_sums() {
  Sums sums;
  for (int pattern = 0; pattern < 128; ++pattern) {
    for (int column = 0; column < pattern_px; ++column) {
      const int pixel = pattern >> column & 1;
      sums.n[pattern] = static_cast<std::uint8_t>(sums.n[pattern] + pixel);
      sums.x[pattern] = static_cast<std::uint8_t>(sums.x[pattern] + pixel * column);
      sums.xx[pattern] = static_cast<std::uint8_t>(sums.xx[pattern] + pixel * column * column);
    }
  }
  return sums;
}

struct Table {
  __m512i low, high;
  explicit Table(const std::uint8_t* from) : low(_mm512_load_si512(from)), high(_mm512_load_si512(from + 64)) {}
  [[nodiscard]] __m512i of(__m512i patterns) const { return _mm512_permutex2var_epi8(low, patterns, high); }
};

/// The same bytes in every lane, for the patterns that begin at columns 0, 7 and 14.
inline __m512i bytes(int a, int b, int c) { return _mm512_set1_epi32((a & 255) | (b & 255) << 8 | (c & 255) << 16); }
inline int pixels_of(int left) { return left <= 0 ? 0 : left >= pattern_px ? 127 : (1 << left) - 1; }

inline void moments(const ProbeWindows& w, ProbeMoments& m) {
  static constexpr Sums sums = make_sums();
  const Table count(sums.n), sum(sums.x), squares(sums.xx);
  const int size = w.columns;
  const int a = -(size / 2), b = a + pattern_px, c = b + pattern_px;  // first columns, from the middle
  const __m512i inside = bytes(pixels_of(size), pixels_of(size - pattern_px), pixels_of(size - 2 * pattern_px));
  const __m512i once = bytes(1, 1, 1);
  const __m512i first = bytes(a, b, c);
  const __m512i twice = bytes(2 * a, 2 * b, 2 * c);
  // Up to 100 where there are pixels. Where there are none it may wrap, for nothing is multiplied by it.
  const __m512i square = bytes(a * a, b * b, c * c);
  // Each byte of a lane takes eight bits from its place on; the upper lane of each pair stands 32 bits higher.
  const __m512i shift = _mm512_mullo_epi32(_mm512_load_si512(w.shift), _mm512_set1_epi32(0x010101));
  const __m512i from = _mm512_add_epi8(shift, _mm512_set1_epi64(0x002E2720000E0700LL));
  const auto asked = static_cast<__mmask16>(w.asked);
  const __m512i zero = _mm512_setzero_si512();
  __m512i offset = _mm512_load_si512(w.offset);
  __m512i n = zero, x = zero, y = zero, xx = zero, xy = zero, yy = zero;
  for (int dy = -w.radius; dy <= w.radius; ++dy) {
    const __m512i row = _mm512_mask_i32gather_epi32(zero, asked, offset, w.bytes, 1);
    const __m512i patterns = _mm512_and_si512(_mm512_multishift_epi64_epi8(from, row), inside);
    const __m512i row_n = count.of(patterns);
    const __m512i row_x = _mm512_dpbusd_epi32(_mm512_dpbusd_epi32(zero, sum.of(patterns), once), row_n, first);
    const __m512i all = _mm512_dpbusd_epi32(zero, row_n, once);
    n = _mm512_add_epi32(n, all);
    x = _mm512_add_epi32(x, row_x);
    y = _mm512_dpbusd_epi32(y, row_n, _mm512_set1_epi8(static_cast<char>(dy)));
    xx = _mm512_dpbusd_epi32(xx, squares.of(patterns), once);
    xx = _mm512_dpbusd_epi32(xx, sum.of(patterns), twice);
    xx = _mm512_dpbusd_epi32(xx, row_n, square);
    xy = _mm512_dpwssd_epi32(xy, row_x, _mm512_set1_epi32(dy & 0xFFFF));
    yy = _mm512_dpwssd_epi32(yy, all, _mm512_set1_epi32(dy * dy));
    offset = _mm512_add_epi32(offset, _mm512_set1_epi32(w.stride));
  }
  _mm512_mask_storeu_epi32(m.n, asked, n);
  _mm512_mask_storeu_epi32(m.x, asked, x);
  _mm512_mask_storeu_epi32(m.y, asked, y);
  _mm512_mask_storeu_epi32(m.xx, asked, xx);
  _mm512_mask_storeu_epi32(m.xy, asked, xy);
  _mm512_mask_storeu_epi32(m.yy, asked, yy);
}

}  // namespace probe_avx512
}  // namespace
}  // namespace touchline
