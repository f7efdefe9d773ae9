// SPDX-License-Identifier: Apache-2.0
// The loop of luma_bands.h for the usual range, eight chroma samples at a time: less than half of the hues, no gray,
// and no largest saturation. Included by files of kernels for AVX2 and later alone; the results are those of
// luma_bands_loops.h.
#pragma once

#include <immintrin.h>

#include "vision/image/luma_bands_loops.h"

namespace touchline {
namespace {
namespace bands_avx2 {

inline bool is_usual(const HsvBandPlan& f) {
  return !f.any_hue && !f.wide && f.divisor_high == 0 && f.divisor_low > 0 && f.neutral.low > f.neutral.high;
}

/// a and b of 16 bits in each lane, to be multiplied with a sample's cb and cr.
[[gnu::always_inline]] inline __m256i pairs(std::int32_t a, std::int32_t b) {
  const std::uint32_t both = (static_cast<std::uint32_t>(a) & 0xFFFFU) | static_cast<std::uint32_t>(b) << 16;
  return _mm256_set1_epi32(static_cast<std::int32_t>(both));
}

/// A half plane's numbers take 17 bits: the lowest of each apart.
struct HalfPlane {
  __m256i halves, rest;

  [[gnu::always_inline]] explicit HalfPlane(const ChromaHalfPlane& p)
      : halves(pairs(p.a >> 1, p.b >> 1)), rest(pairs(p.a & 1, p.b & 1)) {}
  [[gnu::always_inline]] __m256i at(__m256i chroma) const {
    return _mm256_add_epi32(_mm256_slli_epi32(_mm256_madd_epi16(chroma, halves), 1), _mm256_madd_epi16(chroma, rest));
  }
};

class UsualRange {
 public:
  [[gnu::always_inline]] explicit UsualRange(const HsvBandPlan& f)
      : from_(f.from),
        to_(f.to),
        divisor_(_mm256_set1_epi32(f.divisor_low)),
        reciprocal_(_mm256_set1_epi32(static_cast<std::int32_t>(f.reciprocal_low))),
        floor_(_mm256_set1_epi32(f.value_low == 0 ? -bands::beyond_all : f.value_low)),
        ceiling_(_mm256_set1_epi32(f.value_high == 255 ? bands::beyond_all : f.value_high)) {}

  /// Of sixteen samples.
  [[gnu::always_inline]] void operator()(const std::uint8_t* cb, const std::uint8_t* cr, std::uint8_t* low,
                                         std::uint8_t* high) const {
    const __m128i b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cb));
    const __m128i r = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cr));
    const Bands first = eight(_mm_unpacklo_epi8(b, r));
    const Bands second = eight(_mm_unpackhi_epi8(b, r));
    const __m256i parts =
        _mm256_packus_epi16(_mm256_packs_epi32(first.low, second.low), _mm256_packs_epi32(first.high, second.high));
    const __m256i both = _mm256_permutevar8x32_epi32(parts, _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(low), _mm256_castsi256_si128(both));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(high), _mm256_extracti128_si256(both, 1));
  }

 private:
  struct Bands {
    __m256i low, high;  // 32 bits each; empty: 255 and 0
  };

  /// Bytes cb, cr, cb, cr, ... The steps are those of bands::hsv_samples().
  [[gnu::always_inline]] Bands eight(__m128i samples) const {
    const __m256i chroma = _mm256_sub_epi16(_mm256_cvtepu8_epi16(samples), _mm256_set1_epi16(128));
    const __m256i red = _mm256_madd_epi16(chroma, pairs(0, 359));
    const __m256i green = _mm256_madd_epi16(chroma, pairs(-88, -183));
    const __m256i blue = _mm256_madd_epi16(chroma, pairs(454, 0));
    const __m256i largest = _mm256_max_epi32(_mm256_max_epi32(red, green), blue);
    const __m256i least = _mm256_min_epi32(_mm256_min_epi32(red, green), blue);
    const __m256i offset = _mm256_srai_epi32(_mm256_add_epi32(largest, _mm256_set1_epi32(128)), bands::offset_bits);

    const __m256i scale = _mm256_set1_epi32(510);
    const __m256i t = _mm256_sub_epi32(_mm256_mullo_epi32(largest, _mm256_sub_epi32(scale, divisor_)),
                                       _mm256_mullo_epi32(least, scale));
    const __m256i up_to = _mm256_min_epi32(quotient(t), _mm256_sub_epi32(ceiling_, offset));
    const __m256i from = _mm256_max_epi32(_mm256_sub_epi32(floor_, offset), _mm256_setzero_si256());
    // Signs: before the last hue, not before the first one, and some luma left. The largest offset is never negative,
    // so `from` is at most 255.
    const __m256i inside = _mm256_andnot_si256(_mm256_or_si256(from_.at(chroma), up_to), to_.at(chroma));
    const __m256i mask = _mm256_srai_epi32(inside, 31);
    return {_mm256_or_si256(from, _mm256_andnot_si256(mask, _mm256_set1_epi32(255))), _mm256_and_si256(up_to, mask)};
  }

  /// bands::luma_quotient(): at most 256; negative where t is.
  [[gnu::always_inline]] __m256i quotient(__m256i t) const {
    const __m256i u =
        _mm256_min_epi32(_mm256_max_epi32(_mm256_srai_epi32(t, bands::offset_bits), _mm256_setzero_si256()),
                         _mm256_slli_epi32(divisor_, 8));
    const __m256i estimate = _mm256_srli_epi32(_mm256_mullo_epi32(u, reciprocal_), 23);
    const __m256i rest = _mm256_sub_epi32(u, _mm256_madd_epi16(estimate, divisor_));  // both in 16 bits
    const __m256i one_less = _mm256_cmpgt_epi32(divisor_, rest);                      // -1 where the estimate is right
    const __m256i q = _mm256_add_epi32(_mm256_add_epi32(estimate, _mm256_set1_epi32(1)), one_less);
    return _mm256_or_si256(q, _mm256_srai_epi32(t, 31));
  }

  HalfPlane from_, to_;
  __m256i divisor_, reciprocal_, floor_, ceiling_;
};

inline void hsv_rows(const HsvBandPlan& plan, const BandRows& rows) {
  if (!is_usual(plan)) {
    bands::hsv_rows(plan, rows);
    return;
  }
  const HsvBandPlan f = plan;
  const BandRows r = rows;
  const UsualRange range(f);
  bands::in_rows(
      r, [&](int first, int count, std::uint8_t* low, std::uint8_t* high) __attribute__((always_inline)) {
        if (f.rare && !bands::has_hue(f, r.cb + first, r.cr + first, count)) return false;
        if (count == bands::word_samples) {
#pragma GCC unroll 1  // or the numbers of both do not fit into the registers
          for (int i = 0; i < bands::word_samples; i += 16)
            range(r.cb + first + i, r.cr + first + i, low + i, high + i);
        } else {
          bands::hsv_samples(f, r.cb + first, r.cr + first, count, low, high);
        }
        return true;
      });
}

}  // namespace bands_avx2
}  // namespace
}  // namespace touchline
