// SPDX-License-Identifier: Apache-2.0
// The loops of carpet_rows.h in registers of 64 bytes: the sixteen samples of a word at a time. Included by files of
// kernels for AVX-512 alone; the results are those of carpet_rows_loops.h, and so are the steps.
#pragma once

#include <immintrin.h>

#include "vision/image/carpet_rows.h"
#include "vision/image/carpet_rows_loops.h"

namespace touchline {
namespace {
namespace carpet_avx512 {

inline constexpr int lanes = carpet::lanes;

/// A lane for each sample of a word: of four pixels the third, of two chroma samples the second.
struct Samples {
  __m512i pixels;  // 32 bits: the one to the left of the sample, the sample, the one to the right in bytes 1 to 3
  __m512i chroma;  // cb and cr as differences from grey, 16 bits each
  __mmask16 wanted;
  __mmask16 inner;  // both neighbours are carpet's
};

/// Of the bits of a word those of the samples, a bit a lane.
[[gnu::always_inline]] inline __mmask16 of_samples(std::uint64_t word) {
  return _mm512_test_epi32_mask(_mm512_movm_epi8(word), _mm512_set1_epi32(0x00FF0000));
}

/// visit(Samples) for the words that have samples.
template <typename Visit>
[[gnu::always_inline]] inline void in_words(const CarpetRow& row, Visit visit) {
  for (int first = 0, i = 0; first < row.width; first += carpet::word_px, ++i) {
    const std::uint64_t wanted = row.mask[i] & CarpetRow::samples;
    if (wanted == 0) continue;
    const int used = carpet::least(row.width - first, carpet::word_px);
    const __mmask64 pixels = ~__mmask64{0} >> (carpet::word_px - used);
    const __mmask32 samples = ~__mmask32{0} >> (carpet::half - (used + 1) / 2);
    const __m256i cb = _mm256_maskz_loadu_epi8(samples, row.cb + first / 2);
    const __m256i cr = _mm256_maskz_loadu_epi8(samples, row.cr + first / 2);
    const __m512i b = _mm512_cvtepu16_epi32(_mm256_srli_epi16(cb, 8));
    const __m512i r = _mm512_slli_epi32(_mm512_cvtepu16_epi32(_mm256_srli_epi16(cr, 8)), 16);
    visit(Samples{_mm512_maskz_loadu_epi8(pixels, row.y + first),
                  _mm512_sub_epi16(_mm512_or_si512(b, r), _mm512_set1_epi16(128)), of_samples(wanted),
                  of_samples(row.around[i] << 1 & row.around[i] >> 1)});
  }
}

/// a and b of 16 bits in each lane, to be multiplied with a sample's cb and cr.
[[gnu::always_inline]] inline __m512i pairs(std::int32_t a, std::int32_t b) {
  const std::uint32_t both = (static_cast<std::uint32_t>(a) & 0xFFFFU) | static_cast<std::uint32_t>(b) << 16;
  return _mm512_set1_epi32(static_cast<std::int32_t>(both));
}
[[gnu::always_inline]] inline __m512i all(std::int32_t value) { return _mm512_set1_epi32(value); }
[[gnu::always_inline]] inline __m512i byte_of(__m512i v, unsigned i) {
  return _mm512_and_si512(_mm512_srli_epi32(v, 8 * i), all(255));
}

/// carpet::quotient(): the estimate, by a reciprocal of 14 bits, is off by one at most.
[[gnu::always_inline]] inline __m512i quotient(__m512i n, __m512i d) {
  const __m512i held = _mm512_min_epi32(n, _mm512_slli_epi32(d, 8));
  const __m512i q =
      _mm512_cvttps_epi32(_mm512_mul_ps(_mm512_cvtepi32_ps(held), _mm512_rcp14_ps(_mm512_cvtepi32_ps(d))));
  const __m512i rest = _mm512_sub_epi32(held, _mm512_mullo_epi32(q, d));
  const __m512i more = _mm512_mask_add_epi32(q, _mm512_cmpge_epi32_mask(rest, d), q, all(1));
  return _mm512_mask_sub_epi32(more, _mm512_cmplt_epi32_mask(rest, _mm512_setzero_si512()), more, all(1));
}

struct Colours {
  __m512i hue, saturation, value;
};

/// carpet::colour_of().
[[gnu::always_inline]] inline Colours colours_of(const Samples& s) {
  const __m512i zero = _mm512_setzero_si512();
  const __m512i red = _mm512_madd_epi16(s.chroma, pairs(0, 359));
  const __m512i green = _mm512_madd_epi16(s.chroma, pairs(-88, -183));
  const __m512i blue = _mm512_madd_epi16(s.chroma, pairs(454, 0));
  const __m512i high = _mm512_max_epi32(_mm512_max_epi32(red, green), blue);
  const __m512i chroma = _mm512_sub_epi32(high, _mm512_min_epi32(_mm512_min_epi32(red, green), blue));
  const __m512i value = _mm512_add_epi32(_mm512_slli_epi32(byte_of(s.pixels, 2), 8), high);

  // Half units of 60 degrees' 1 / 60, times chroma, from the channel that is largest; the first of equal ones.
  const __mmask16 from_green = _mm512_cmpeq_epi32_mask(high, green);
  const __mmask16 from_red = _mm512_cmpeq_epi32_mask(high, red);
  __m512i step = _mm512_sub_epi32(red, green);
  step = _mm512_mask_sub_epi32(step, from_green, blue, red);
  step = _mm512_mask_sub_epi32(step, from_red, green, blue);
  __m512i base = _mm512_mask_mov_epi32(all(240), from_green, all(120));
  base = _mm512_maskz_mov_epi32(static_cast<__mmask16>(~from_red), base);
  __m512i half_units = _mm512_add_epi32(_mm512_mullo_epi32(step, all(60)), _mm512_mullo_epi32(base, chroma));
  half_units = _mm512_mask_add_epi32(half_units, _mm512_cmplt_epi32_mask(half_units, zero), half_units,
                                     _mm512_mullo_epi32(chroma, all(360)));
  const __m512i hue =
      quotient(_mm512_add_epi32(half_units, chroma), _mm512_max_epi32(_mm512_add_epi32(chroma, chroma), all(1)));
  const __m512i above_zero = _mm512_max_epi32(value, zero);
  const __m512i saturation =
      _mm512_min_epi32(quotient(_mm512_add_epi32(_mm512_mullo_epi32(chroma, all(510)), above_zero),
                                _mm512_max_epi32(_mm512_add_epi32(value, value), all(1))),
                       all(255));
  const __m512i held = _mm512_mask_mov_epi32(all(255), _mm512_cmpgt_epi32_mask(value, zero), saturation);
  return {_mm512_maskz_mov_epi32(_mm512_cmpneq_epi32_mask(hue, all(180)), hue),
          _mm512_maskz_mov_epi32(_mm512_cmpneq_epi32_mask(chroma, zero), held),
          _mm512_min_epi32(_mm512_srai_epi32(_mm512_add_epi32(above_zero, all(128)), 8), all(255))};
}

/// Lanes low..high.
[[gnu::always_inline]] inline __mmask16 between(__mmask16 of, __m512i v, std::int32_t low, std::int32_t high) {
  return _mm512_mask_cmple_epi32_mask(_mm512_mask_cmpge_epi32_mask(of, v, all(low)), v, all(high));
}

/// Lanes that are picked, one behind the other, for the counting that goes one by one: many at once, so that the
/// vectors' work of one word need not wait for the counting of another.
template <typename Count>
class Picked {
 public:
  [[gnu::always_inline]] explicit Picked(Count count) : count_(count) {}
  [[gnu::always_inline]] void add(__mmask16 mask, __m512i v) {
    if (size_ > room - lanes) flush();
    _mm512_storeu_si512(values_ + size_, _mm512_maskz_compress_epi32(mask, v));
    size_ += __builtin_popcount(mask);
  }
  [[gnu::always_inline]] void flush() {
    for (int i = 0; i < size_; ++i) count_(values_[i]);
    size_ = 0;
  }

 private:
  static constexpr int room = 256;
  std::uint32_t values_[room];
  int size_ = 0;
  Count count_;
};

inline void count_colours(const CarpetRow& row, const HsvRange& range, CarpetColours& colours) {
  const HsvRange gate = range;
  Picked picked([&](std::uint32_t both) __attribute__((always_inline)) {
    ++colours.hues[both & 255U];
    ++colours.saturations[both >> 8];
  });
  in_words(
      row, [&](const Samples& s) __attribute__((always_inline)) {
        const Colours c = colours_of(s);
        __mmask16 inside =
            gate.hue_low > gate.hue_high
                ? static_cast<__mmask16>(s.wanted & ~between(s.wanted, c.hue, gate.hue_high + 1, gate.hue_low - 1))
                : between(s.wanted, c.hue, gate.hue_low, gate.hue_high);
        inside = between(inside, c.saturation, gate.saturation_low, gate.saturation_high);
        inside = between(inside, c.value, gate.value_low, gate.value_high);
        picked.add(inside, _mm512_or_si512(c.hue, _mm512_slli_epi32(c.saturation, 8)));
        colours.samples += __builtin_popcount(inside);
      });
  picked.flush();
}

inline void sum_chroma(const CarpetRow& row, ChromaSums& sums) {
  __m512i cb = _mm512_setzero_si512(), cr = cb;
  in_words(
      row, [&](const Samples& s) __attribute__((always_inline)) {
        const __m512i wanted = _mm512_maskz_mov_epi32(s.wanted, s.chroma);
        cb = _mm512_dpwssd_epi32(cb, wanted, pairs(1, 0));
        cr = _mm512_dpwssd_epi32(cr, wanted, pairs(0, 1));
        sums.samples += __builtin_popcount(s.wanted);
      });
  sums.cb += _mm512_reduce_add_epi32(cb);
  sums.cr += _mm512_reduce_add_epi32(cr);
}

inline void count_ratios(const CarpetRow& row, const ChromaAxis& given, CarpetRatios& ratios) {
  const __m512i zero = _mm512_setzero_si512();
  const __m512i axis = pairs(given.cb, given.cr);
  __m512i roughness = zero;
  Picked picked([&](std::uint32_t three) __attribute__((always_inline)) {
    ++ratios.greenness[three & 255U];
    ++ratios.chroma[three >> 8 & 255U];
    ++ratios.lumas[three >> 16];
  });
  in_words(
      row, [&](const Samples& s) __attribute__((always_inline)) {
        const __m512i sample = byte_of(s.pixels, 2);
        const __m512i luma = _mm512_max_epi32(sample, all(1));
        const __m512i along = _mm512_max_epi32(_mm512_madd_epi16(s.chroma, axis), zero);
        const __m512i both = _mm512_madd_epi16(_mm512_abs_epi16(s.chroma), _mm512_set1_epi16(256));
        const __m512i greenness = _mm512_min_epi32(quotient(along, luma), all(255));
        const __m512i chroma = _mm512_min_epi32(quotient(both, luma), all(255));
        // Clipped, so that a line's edge does not count as noise.
        const __m512i sides = _mm512_add_epi32(byte_of(s.pixels, 1), _mm512_srli_epi32(s.pixels, 24));
        const __m512i rough = _mm512_abs_epi32(_mm512_sub_epi32(_mm512_add_epi32(sample, sample), sides));
        const __mmask16 inner = s.wanted & s.inner;
        roughness = _mm512_mask_add_epi32(roughness, inner, roughness, _mm512_min_epi32(rough, all(32)));
        ratios.rough_samples += __builtin_popcount(inner);
        picked.add(s.wanted, _mm512_or_si512(_mm512_or_si512(greenness, _mm512_slli_epi32(chroma, 8)),
                                             _mm512_slli_epi32(sample, 16)));
      });
  picked.flush();
  ratios.roughness += _mm512_reduce_add_epi32(roughness);
}

inline CarpetKernels kernels() { return {count_colours, sum_chroma, count_ratios}; }

}  // namespace carpet_avx512
}  // namespace
}  // namespace touchline
