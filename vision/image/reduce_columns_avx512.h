// SPDX-License-Identifier: Apache-2.0
// Weighted sums of neighbouring columns (ColumnSums, kernels.h), four working columns at a time: what they are made of
// lies in two registers, from which the taps are taken in pairs. Included by files of kernels for
// AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/subsample_loops.h"

namespace touchline {
namespace {
namespace reduce_avx512 {

inline constexpr int columns_at_once = 4;  // four lanes of 32 bits each
inline constexpr int words = 32;           // of a register

/// How many samples four columns are made of at the most. The first one of the fourth lies at most as far from that of
/// the first as three working columns are wide, rounded up.
inline int most_samples(const ColumnSums& s) { return 3 * (3 * s.source_columns / s.columns + 1 + s.taps); }

/// Of what there is from `from` on, `left` of it.
[[gnu::always_inline]] inline __m512i load(const std::uint16_t* from, int left) {
  if (left >= words) return _mm512_loadu_si512(from);
  return _mm512_maskz_loadu_epi16(left <= 0 ? 0 : (__mmask32{1} << left) - 1, from);
}

/// Pairs: of taps; 0 where that is told at run time.
template <bool TwoRegisters, int Pairs>
inline void reduce(const ColumnSums& given) {
  const ColumnSums s = given;
  // Sums of up to 16 bits are made signed: what that takes off is the same for all, as all have the same weight.
  const __m512i bias = _mm512_set1_epi16(static_cast<short>(0x8000));
  const __m512i unbias = _mm512_set1_epi32(0x8000 * s.weight);
  // Of each lane's column: the two taps of a channel.
  alignas(64) std::uint16_t steps[32], column[32], second[32];
  for (int lane = 0; lane < 16; ++lane) {
    for (int t = 0; t < 2; ++t) {
      steps[2 * lane + t] = static_cast<std::uint16_t>(lane % 4 + 3 * t);
      column[2 * lane + t] = static_cast<std::uint16_t>(lane / 4);
      second[2 * lane + t] = static_cast<std::uint16_t>(t);
    }
  }
  const __m512i step = _mm512_load_si512(steps), of_column = _mm512_load_si512(column);
  const __m512i weight_of = _mm512_add_epi16(
      _mm512_mullo_epi16(of_column, _mm512_set1_epi16(static_cast<short>(s.taps))), _mm512_load_si512(second));
  const int pairs = Pairs > 0 ? Pairs : (s.taps + 1) / 2;
  const int samples = 3 * s.source_columns;
  const int weights = s.taps * s.columns;
  for (int x = 0; x < s.columns; x += columns_at_once) {
    const int x0 = x + columns_at_once <= s.columns ? x : s.columns - columns_at_once;
    const int begin = 3 * s.first_column[x0];
    const __m512i low = load(s.sums + begin, samples - begin);
    __m512i high{};
    if constexpr (TwoRegisters) high = load(s.sums + begin + words, samples - begin - words);
    const __m512i taken = load(s.weights + s.taps * x0, weights - s.taps * x0);
    const __m512i firsts =
        _mm512_castsi128_si512(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(s.first_column + x0)));
    const __m512i first = _mm512_sub_epi16(_mm512_permutexvar_epi16(of_column, firsts),
                                           _mm512_set1_epi16(static_cast<short>(s.first_column[x0])));
    __m512i place = _mm512_add_epi16(_mm512_add_epi16(first, _mm512_add_epi16(first, first)), step);
    __m512i weight = weight_of;
    __m512i total = unbias;
    for (int t = 0; t < 2 * pairs; t += 2) {
      const __m512i both =
          TwoRegisters ? _mm512_permutex2var_epi16(low, place, high) : _mm512_permutexvar_epi16(place, low);
      const __m512i pixels = _mm512_xor_si512(both, bias);
      const __mmask32 there = t + 1 < s.taps ? ~__mmask32{0} : __mmask32{0x55555555};
      total = _mm512_dpwssd_epi32(total, pixels, _mm512_maskz_permutexvar_epi16(there, weight, taken));
      place = _mm512_add_epi16(place, _mm512_set1_epi16(6));
      weight = _mm512_add_epi16(weight, _mm512_set1_epi16(2));
    }
    const __m512i shifted = _mm512_srl_epi32(total, _mm_cvtsi32_si128(s.shift));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(s.out + 4 * x0), _mm512_cvtepi32_epi16(shifted));
  }
}

inline void reduce_columns(const ColumnSums& s) {
  const int samples = s.columns < columns_at_once || s.taps * columns_at_once > words ? 3 * words : most_samples(s);
  if (samples <= words) return s.taps == 3 || s.taps == 4 ? reduce<false, 2>(s) : reduce<false, 0>(s);
  if (samples <= 2 * words) return reduce<true, 0>(s);
  subsample_loops::reduce_columns(s);
}

}  // namespace reduce_avx512
}  // namespace
}  // namespace touchline
