// SPDX-License-Identifier: Apache-2.0
// The loops of luma_bands.h in registers of 64 bytes: a word of 64 pixels and its 32 chroma samples at a time. Included
// by files of kernels for AVX-512 alone; the results are those of luma_bands_loops.h.
#pragma once

#include <immintrin.h>

#include "vision/image/luma_bands_avx2.h"

namespace touchline {
namespace {
namespace bands_avx512 {

/// Chroma as differences from grey, cb and cr in the words of a lane: samples 0-3, 8-11, ... and 4-7, 12-15, ...
struct Chroma {
  __m512i half[2];
};
/// 32 numbers of 32 bits in the order of Chroma become words in the order of the samples, held in 0..65535.
[[gnu::always_inline]] inline __m512i in_order(__m512i first, __m512i second) {
  return _mm512_packus_epi32(first, second);
}
/// From 32 words below 256 to two equal bytes each: one for each pixel.
[[gnu::always_inline]] inline __m512i for_pixels(__m512i words) {
  return _mm512_or_si512(words, _mm512_slli_epi16(words, 8));
}

/// a and b of 16 bits in each lane, to be multiplied with a sample's cb and cr.
[[gnu::always_inline]] inline __m512i pairs(std::int32_t a, std::int32_t b) {
  const std::uint32_t both = (static_cast<std::uint32_t>(a) & 0xFFFFU) | static_cast<std::uint32_t>(b) << 16;
  return _mm512_set1_epi32(static_cast<std::int32_t>(both));
}

/// Words of 64 pixels: visit(chroma, luma of both rows) gives the pixels found in both.
struct Found {
  std::uint64_t row[2];
};
template <typename Visit>
[[gnu::always_inline]] inline void in_rows(const BandRows& r, Visit visit) {
  const __m512i grey = _mm512_set1_epi16(128);
  for (int first = 0, i = 0; first < r.width; first += bands::word_px, ++i) {
    const std::uint64_t wanted[2] = {r.region[0][i], r.region[1][i]};
    Found found = {};
    if ((wanted[0] | wanted[1]) != 0) {
      const int used = bands::least(r.width - first, bands::word_px);
      const __mmask64 pixels = ~__mmask64{0} >> (bands::word_px - used);
      const __mmask32 samples = ~__mmask32{0} >> (bands::word_samples - (used + 1) / 2);
      const __m512i b = _mm512_cvtepu8_epi16(_mm256_maskz_loadu_epi8(samples, r.cb + first / 2));
      const __m512i c = _mm512_cvtepu8_epi16(_mm256_maskz_loadu_epi8(samples, r.cr + first / 2));
      const Chroma chroma = {
          {_mm512_sub_epi16(_mm512_unpacklo_epi16(b, c), grey), _mm512_sub_epi16(_mm512_unpackhi_epi16(b, c), grey)}};
      found = visit(chroma, _mm512_maskz_loadu_epi8(pixels, r.y[0] + first),
                    _mm512_maskz_loadu_epi8(pixels, r.y[1] + first));
    }
    r.out[0][i] = found.row[0] & wanted[0];
    r.out[1][i] = found.row[1] & wanted[1];
  }
}

/// A half plane's numbers take 17 bits: the lowest of each apart.
struct HalfPlane {
  __m512i halves, rest;

  [[gnu::always_inline]] explicit HalfPlane(const ChromaHalfPlane& p)
      : halves(pairs(p.a >> 1, p.b >> 1)), rest(pairs(p.a & 1, p.b & 1)) {}
  [[gnu::always_inline]] __m512i at(__m512i chroma) const {
    return _mm512_dpwssd_epi32(_mm512_slli_epi32(_mm512_madd_epi16(chroma, halves), 1), chroma, rest);
  }
};

/// A range of bands_avx2::is_usual().
class UsualRange {
 public:
  [[gnu::always_inline]] explicit UsualRange(const HsvBandPlan& f)
      : from_(f.from),
        to_(f.to),
        pale_(_mm512_set1_epi16(static_cast<short>(f.least_chroma - 1))),
        largest_factor_(_mm512_set1_epi32(510 - f.divisor_low)),
        reciprocal_(_mm512_set1_ps(1.0F / static_cast<float>(f.divisor_low))),
        floor_(_mm512_set1_epi32(f.value_low == 0 ? -bands::beyond_all : f.value_low)),
        ceiling_(_mm512_set1_epi32(f.value_high == 255 ? bands::beyond_all : f.value_high)) {}

  /// Samples whose hue is the range's.
  [[gnu::always_inline]] __mmask16 hue(__m512i chroma) const {
    const __m512i zero = _mm512_setzero_si512();
    return _mm512_mask_cmplt_epi32_mask(_mm512_cmpge_epi32_mask(from_.at(chroma), zero), to_.at(chroma), zero);
  }
  /// Of these, those that any luma could leave in the range.
  [[gnu::always_inline]] __mmask16 strong(__mmask16 of, __m512i chroma) const {
    const __m512i beyond = _mm512_subs_epu16(_mm512_abs_epi16(chroma), pale_);
    return _mm512_mask_test_epi32_mask(of, beyond, beyond);
  }

  struct Bands {
    __m512i low, high;  // 32 bits each; empty: 255 and 0
  };
  /// The steps are those of bands::hsv_samples().
  [[gnu::always_inline]] Bands bands(__m512i chroma, __mmask16 of_hue) const {
    const __m512i zero = _mm512_setzero_si512();
    const __m512i red = _mm512_madd_epi16(chroma, pairs(0, 359));
    const __m512i green = _mm512_madd_epi16(chroma, pairs(-88, -183));
    const __m512i blue = _mm512_madd_epi16(chroma, pairs(454, 0));
    const __m512i largest = _mm512_max_epi32(_mm512_max_epi32(red, green), blue);
    const __m512i least = _mm512_min_epi32(_mm512_min_epi32(red, green), blue);
    const __m512i offset = _mm512_srai_epi32(_mm512_add_epi32(largest, _mm512_set1_epi32(128)), bands::offset_bits);
    const __m512i t = _mm512_sub_epi32(_mm512_mullo_epi32(largest, largest_factor_),
                                       _mm512_mullo_epi32(least, _mm512_set1_epi32(510)));
    const __m512i up_to = _mm512_min_epi32(quotient(t), _mm512_sub_epi32(ceiling_, offset));
    const __m512i from = _mm512_max_epi32(_mm512_sub_epi32(floor_, offset), zero);
    const __mmask16 inside = _mm512_mask_cmpge_epi32_mask(of_hue, up_to, zero);
    return {_mm512_mask_mov_epi32(_mm512_set1_epi32(255), inside, from), _mm512_maskz_mov_epi32(inside, up_to)};
  }

 private:
  /// floor(t / (256 * divisor)). u below is under 2^18 and the divisor d under 2^9: (u + 1/2) / d is at least 1 / (2 d)
  /// away from an integer, and floating point at most a tenth of that from the truth.
  [[gnu::always_inline]] __m512i quotient(__m512i t) const {
    const __m512 u = _mm512_cvtepi32_ps(_mm512_srai_epi32(t, bands::offset_bits));
    const __m512 middle = _mm512_mul_ps(_mm512_add_ps(u, _mm512_set1_ps(0.5F)), reciprocal_);
    return _mm512_cvt_roundps_epi32(middle, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
  }

  HalfPlane from_, to_;
  __m512i pale_, largest_factor_;
  __m512 reciprocal_;
  __m512i floor_, ceiling_;
};

inline void hsv_rows(const HsvBandPlan& plan, const BandRows& rows) {
  if (!bands_avx2::is_usual(plan)) {
    bands::hsv_rows(plan, rows);
    return;
  }
  const UsualRange range(plan);
  const bool rare = plan.rare;
  const __m512i most = _mm512_set1_epi16(255);
  in_rows(
      rows, [&](const Chroma& c, __m512i upper, __m512i lower) __attribute__((always_inline)) {
        const __mmask16 hue[2] = {range.hue(c.half[0]), range.hue(c.half[1])};
        if (rare && (range.strong(hue[0], c.half[0]) | range.strong(hue[1], c.half[1])) == 0) return Found{};
        const UsualRange::Bands first = range.bands(c.half[0], hue[0]);
        const UsualRange::Bands second = range.bands(c.half[1], hue[1]);
        const __m512i low = for_pixels(in_order(first.low, second.low));
        const __m512i high = for_pixels(_mm512_min_epu16(in_order(first.high, second.high), most));
        return Found{{_mm512_mask_cmple_epu8_mask(_mm512_cmpge_epu8_mask(upper, low), upper, high),
                      _mm512_mask_cmple_epu8_mask(_mm512_cmpge_epu8_mask(lower, low), lower, high)}};
      });
}

/// The least luma of white for sixteen chroma samples, as bands::least_white().
struct LeastWhite {
  __m512i axis, per_green, per_chroma, shadow_luma;

  [[gnu::always_inline]] explicit LeastWhite(const CarpetLimits& f)
      : axis(pairs(f.axis_cb, f.axis_cr)),
        per_green(_mm512_set1_epi32(f.per_green)),
        per_chroma(_mm512_set1_epi32(f.per_chroma)),
        shadow_luma(_mm512_set1_epi32(f.shadow_luma)) {}
  [[gnu::always_inline]] __m512i operator()(__m512i chroma) const {
    const __m512i zero = _mm512_setzero_si512();
    const __m512i along = _mm512_srai_epi32(_mm512_max_epi32(_mm512_madd_epi16(chroma, axis), zero), 8);
    const __m512i by_green = _mm512_srai_epi32(_mm512_mullo_epi32(along, per_green), 8);
    const __m512i both = _mm512_madd_epi16(_mm512_abs_epi16(chroma), _mm512_set1_epi16(1));
    const __m512i by_chroma = _mm512_srai_epi32(_mm512_mullo_epi32(both, per_chroma), 8);
    return _mm512_max_epi32(_mm512_max_epi32(shadow_luma, by_green), by_chroma);
  }
};

inline void white_rows(const CarpetLimits& limits, const BandRows& rows) {
  const LeastWhite least_white(limits);
  const __m512i most = _mm512_set1_epi16(255);
  in_rows(
      rows, [&](const Chroma& c, __m512i upper, __m512i lower) __attribute__((always_inline)) {
        const __m512i least =
            for_pixels(_mm512_min_epu16(in_order(least_white(c.half[0]), least_white(c.half[1])), most));
        return Found{{_mm512_cmpge_epu8_mask(upper, least), _mm512_cmpge_epu8_mask(lower, least)}};
      });
}

}  // namespace bands_avx512
}  // namespace
}  // namespace touchline
