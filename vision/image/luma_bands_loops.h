// SPDX-License-Identifier: Apache-2.0
// The loops of luma_bands.h, written so that compilers vectorise them. Included by files of kernels alone, and compiled
// there for that file's processor: everything is local to the file, and no function of another header is called.
#pragma once

#include "vision/image/luma_bands.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace touchline {
namespace {
namespace bands {

inline constexpr std::int32_t beyond_all = 1 << 16;  // beyond any luma: no bound
inline constexpr int offset_bits = 8;
inline constexpr int word_px = 64;
inline constexpr int word_samples = word_px / 2;

[[gnu::always_inline]] inline std::int32_t most(std::int32_t a, std::int32_t b) { return a > b ? a : b; }
[[gnu::always_inline]] inline std::int32_t least(std::int32_t a, std::int32_t b) { return a < b ? a : b; }
[[gnu::always_inline]] inline std::int32_t magnitude(std::int32_t a) { return a < 0 ? -a : a; }

/// floor(t / (256 * divisor)), held in 0..256 (negative becomes -1). Reciprocal: floor(2^23 / divisor); the estimate
/// is at most one too small.
[[gnu::always_inline]] inline std::int32_t luma_quotient(std::int32_t t, std::int32_t divisor,
                                                         std::uint32_t reciprocal) {
  const std::int32_t u = least(most(t >> offset_bits, 0), 256 * divisor);
  auto q = static_cast<std::int32_t>((static_cast<std::uint32_t>(u) * reciprocal) >> 23);
  q += (q + 1) * divisor <= u ? 1 : 0;
  return t < 0 ? -1 : q;
}

/// r, g, b minus luma, in 1/256: 1.402 Cr, -0.344 Cb - 0.714 Cr, 1.772 Cb (the inverse of BT.601).
struct Offsets {
  std::int32_t red, green, blue;
};
[[gnu::always_inline]] inline Offsets offsets(std::int32_t b, std::int32_t r) {
  return {359 * r, -88 * b - 183 * r, 454 * b};
}

/// Whether any sample has a hue of the range; gray has none.
[[gnu::always_inline]] inline bool any_of_hue(const HsvBandPlan& f, const std::uint8_t* cb, const std::uint8_t* cr,
                                              int count) {
  std::int32_t any = 0;
  for (int i = 0; i < count; ++i) {
    const std::int32_t b = cb[i] - 128;
    const std::int32_t r = cr[i] - 128;
    any |= ~(f.from.a * b + f.from.b * r) & (f.to.a * b + f.to.b * r);  // the signs alone
  }
  return any < 0;
}

#if defined(__SSE2__)
/// False when none of a word's samples has a colour of the range: a first look. The half planes' numbers are below 2^16
/// (HsvFilter::at_hue), so their halves fit into lanes of 16 bits, and what the halving loses of the sum is at most
/// 128.
[[gnu::always_inline]] inline bool may_have_hue(const HsvBandPlan& f, const std::uint8_t* cb, const std::uint8_t* cr) {
  const auto halves = [](const ChromaHalfPlane& plane) {
    return _mm_set1_epi32(static_cast<int>((static_cast<std::uint32_t>(plane.a >> 1) & 0xFFFFU) |
                                           static_cast<std::uint32_t>(plane.b >> 1) << 16));
  };
  const __m128i from = halves(f.from), to = halves(f.to);
  const __m128i zero = _mm_setzero_si128(), grey = _mm_set1_epi16(128);
  const __m128i pale = _mm_set1_epi16(static_cast<short>(f.least_chroma - 1));
  const __m128i slack = _mm_set1_epi32(128), below_slack = _mm_set1_epi32(-129);
  __m128i any = zero;
  const auto look = [&](__m128i bytes) __attribute__((always_inline)) {  // cb, cr of four samples
    const __m128i pairs = _mm_sub_epi16(bytes, grey);
    const __m128i strong = _mm_cmpgt_epi16(_mm_max_epi16(pairs, _mm_sub_epi16(zero, pairs)), pale);
    const __m128i inside = _mm_and_si128(_mm_cmpgt_epi32(_mm_madd_epi16(pairs, from), below_slack),
                                         _mm_cmpgt_epi32(slack, _mm_madd_epi16(pairs, to)));
    any = _mm_or_si128(any, _mm_andnot_si128(_mm_cmpeq_epi32(strong, zero), inside));
  };
  const auto look_at_eight = [&](__m128i bytes) __attribute__((always_inline)) {
    look(_mm_unpacklo_epi8(bytes, zero));
    look(_mm_unpackhi_epi8(bytes, zero));
  };
  for (int i = 0; i < word_samples; i += 16) {
    const __m128i b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cb + i));
    const __m128i r = _mm_loadu_si128(reinterpret_cast<const __m128i*>(cr + i));
    look_at_eight(_mm_unpacklo_epi8(b, r));
    look_at_eight(_mm_unpackhi_epi8(b, r));
  }
  return _mm_movemask_epi8(any) != 0;
}
#endif

[[gnu::always_inline]] inline bool has_hue(const HsvBandPlan& f, const std::uint8_t* cb, const std::uint8_t* cr,
                                           int count) {
#if defined(__SSE2__)
  if (count == word_samples) return may_have_hue(f, cb, cr);
#endif
  return any_of_hue(f, cb, cr, count);
}

/// No branch in the loop, so that it vectorises.
[[gnu::always_inline]] inline void hsv_samples(const HsvBandPlan& f, const std::uint8_t* cb, const std::uint8_t* cr,
                                               int count, std::uint8_t* low, std::uint8_t* high) {
  const std::int32_t any = f.any_hue ? 1 : 0;
  const std::int32_t wide = f.wide ? 1 : 0;
  const std::int32_t value_floor = f.value_low == 0 ? -beyond_all : f.value_low;
  const std::int32_t value_ceiling = f.value_high == 255 ? beyond_all : f.value_high;
  for (int i = 0; i < count; ++i) {
    const std::int32_t b = cb[i] - 128;
    const std::int32_t r = cr[i] - 128;
    const Offsets o = offsets(b, r);
    const std::int32_t largest = most(most(o.red, o.green), o.blue);
    const std::int32_t chroma = largest - least(least(o.red, o.green), o.blue);
    const std::int32_t past_first = f.from.a * b + f.from.b * r >= 0 ? 1 : 0;
    const std::int32_t before_last = f.to.a * b + f.to.b * r < 0 ? 1 : 0;
    const std::int32_t hue = any | (past_first & before_last) | (wide & (past_first | before_last));

    const std::int32_t value_offset = (largest + 128) >> offset_bits;
    const std::int32_t above_high =
        luma_quotient(510 * chroma - f.divisor_high * largest, f.divisor_high, f.reciprocal_high) + 1;
    const std::int32_t up_to_low =
        luma_quotient(510 * chroma - f.divisor_low * largest, f.divisor_low, f.reciprocal_low);
    const std::int32_t at_least = f.divisor_high == 0 ? 0 : above_high;
    const std::int32_t at_most = f.divisor_low == 0 ? 255 : up_to_low;
    const std::int32_t from = most(most(0, value_floor - value_offset), at_least);
    const std::int32_t to = least(least(255, value_ceiling - value_offset), at_most);
    const std::int32_t inside = hue & (from <= to ? 1 : 0);
    const std::int32_t coloured_low = inside != 0 ? from : 255;
    const std::int32_t coloured_high = inside != 0 ? to : 0;
    low[i] = static_cast<std::uint8_t>(chroma == 0 ? f.neutral.low : coloured_low);
    high[i] = static_cast<std::uint8_t>(chroma == 0 ? f.neutral.high : coloured_high);
  }
}

[[gnu::always_inline]] inline std::int32_t least_white(const CarpetLimits& f, std::int32_t b, std::int32_t r) {
  const std::int32_t along = most(b * f.axis_cb + r * f.axis_cr, 0) >> 8;
  const std::int32_t by_green = (along * f.per_green) >> 8;
  const std::int32_t by_chroma = ((magnitude(b) + magnitude(r)) * f.per_chroma) >> 8;
  return least(most(most(f.shadow_luma, by_green), by_chroma), 255);
}

[[gnu::always_inline]] inline void white_samples(const CarpetLimits& f, const std::uint8_t* cb, const std::uint8_t* cr,
                                                 int count, std::uint8_t* low) {
  for (int i = 0; i < count; ++i) low[i] = static_cast<std::uint8_t>(least_white(f, cb[i] - 128, cr[i] - 128));
}

/// Up to 64 pixels: a bit each.
inline std::uint64_t band_word(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high, int used) {
  // Whole words of fixed length: 32 chroma samples, each twice, and 64 lumas.
  std::uint8_t from[word_px] = {};
  std::uint8_t to[word_px] = {};
  std::uint8_t flags[word_px] = {};
  const int samples = (used + 1) / 2;
  for (int i = 0; i < samples; ++i) {
    from[2 * i] = from[2 * i + 1] = low[i];
    to[2 * i] = to[2 * i + 1] = high[i];
  }
  for (int i = 0; i < used; ++i) {
    flags[i] = static_cast<std::uint8_t>((y[i] >= from[i] ? 1 : 0) & (y[i] <= to[i] ? 1 : 0));
  }
  std::uint64_t word = 0;
  for (int i = 0; i < 8; ++i) {
    // Byte k, at bit 8 k, moves to bit 56 + k.
    std::uint64_t eight = 0;
    __builtin_memcpy(&eight, flags + 8 * i, sizeof eight);
    word |= ((eight * 0x0102040810204080U) >> 56) << (8 * i);
  }
  return word;
}

#if defined(__AVX2__)
/// 32 pixels and their 16 chroma samples.
[[gnu::always_inline]] inline std::uint32_t band_half(const std::uint8_t* y, const std::uint8_t* low,
                                                      const std::uint8_t* high) {
  const auto twice = [](const std::uint8_t* from) {
    const __m128i samples = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from));
    return _mm256_inserti128_si256(_mm256_castsi128_si256(_mm_unpacklo_epi8(samples, samples)),
                                   _mm_unpackhi_epi8(samples, samples), 1);
  };
  const __m256i luma = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(y));
  const __m256i enough = _mm256_cmpeq_epi8(_mm256_max_epu8(luma, twice(low)), luma);
  const __m256i not_more = _mm256_cmpeq_epi8(_mm256_min_epu8(luma, twice(high)), luma);
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_and_si256(enough, not_more)));
}
#endif

[[gnu::always_inline]] inline std::uint64_t whole_word(const std::uint8_t* y, const std::uint8_t* low,
                                                       const std::uint8_t* high) {
#if defined(__AVX2__)
  return band_half(y, low, high) | std::uint64_t{band_half(y + 32, low + 16, high + 16)} << 32;
#else
  return band_word(y, low, high, word_px);
#endif
}

/// make(first, count, low, high): the bands of some chroma samples of the row; false when they are all empty.
template <typename Make>
[[gnu::always_inline]] inline void in_rows(const BandRows& rows, Make make) {
  std::uint8_t low[word_samples];
  std::uint8_t high[word_samples];
  for (int first = 0, i = 0; first < rows.width; first += word_px, ++i) {
    const std::uint64_t wanted[2] = {rows.region[0][i], rows.region[1][i]};
    std::uint64_t found[2] = {};
    if ((wanted[0] | wanted[1]) != 0) {
      const int used = least(rows.width - first, word_px);
      const bool any =
          used == word_px ? make(first / 2, word_samples, low, high) : make(first / 2, (used + 1) / 2, low, high);
      for (int v = 0; v < 2 && any; ++v) {
        const std::uint8_t* y = rows.y[v] + first;
        found[v] = (used == word_px ? whole_word(y, low, high) : band_word(y, low, high, used)) & wanted[v];
      }
    }
    rows.out[0][i] = found[0];
    rows.out[1][i] = found[1];
  }
}

inline void hsv_rows(const HsvBandPlan& plan, const BandRows& rows) {
  const HsvBandPlan f = plan;  // a copy that no store through `low` can change: the loop stays in registers
  const BandRows r = rows;
  in_rows(
      r, [&f, &r ](int first, int count, std::uint8_t* low, std::uint8_t* high) __attribute__((always_inline)) {
        if (f.rare && !has_hue(f, r.cb + first, r.cr + first, count)) return false;
        hsv_samples(f, r.cb + first, r.cr + first, count, low, high);
        return true;
      });
}

inline void white_rows(const CarpetLimits& limits, const BandRows& rows) {
  const CarpetLimits f = limits;
  const BandRows r = rows;
  in_rows(
      r, [&f, &r ](int first, int count, std::uint8_t* low, std::uint8_t* high) __attribute__((always_inline)) {
        white_samples(f, r.cb + first, r.cr + first, count, low);
        for (int i = 0; i < word_samples; ++i) high[i] = 255;
        return true;
      });
}

}  // namespace bands
}  // namespace
}  // namespace touchline
