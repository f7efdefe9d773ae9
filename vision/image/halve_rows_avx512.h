// SPDX-License-Identifier: Apache-2.0
// Averaging, subsampling and change of colours of the usual frames (HalvedFrame, kernels.h), sixteen working columns of
// two rows at a time. Included by files of kernels for AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/halve_rows_avx2.h"
#include "vision/image/kernels.h"

namespace touchline {
namespace {
namespace halve_avx512 {

inline constexpr int lanes = 16;          // working columns of a step, one in 32 bits
inline constexpr int taps = 4;            // source columns that a working column is made of, at most
inline constexpr int window_bytes = 128;  // of each source row that a step may need
inline constexpr int line_bytes = 64;     // of the caches
inline constexpr int most_phases = 8;
inline constexpr int fraction_bits = 6;
inline constexpr int colour_shift = colour_bits + fraction_bits;

/// Where a step finds the first channel's bytes in its window, and their weights. Lane i < 8 is column 2 i of the step,
/// the others are the odd columns.
struct Phase {
  alignas(64) std::uint8_t places[lanes * taps];
  alignas(64) std::int8_t weights[lanes * taps];
};
struct Phases {
  Phase phase[most_phases];
  int count = 0;
};

/// After this many columns the steps' phases repeat.
inline int columns_until_repeat(const HalvedFrame& f) {
  int columns = lanes;
  while (columns % f.period != 0 && columns < f.columns) columns += lanes;
  return columns;
}

/// False where the frame's ratio has too many phases, or its windows are too wide.
inline bool make_phases(const HalvedFrame& f, Phases& out) {
  if (f.columns % lanes != 0) return false;
  out.count = columns_until_repeat(f) / lanes;
  if (out.count > most_phases) return false;
  for (int k = 0; k < out.count; ++k) {
    const int begin = 3 * f.first_column[k * lanes];
    for (int i = 0; i < lanes; ++i) {
      const int x = k * lanes + 2 * (i % (lanes / 2)) + 2 * i / lanes;
      const int first = 3 * f.first_column[x] - begin;
      if (first + 3 * taps > window_bytes) return false;
      const std::int8_t* weights = f.weights + 16 * (x % f.period);
      for (int t = 0; t < taps; ++t) {
        out.phase[k].places[taps * i + t] = static_cast<std::uint8_t>(first + 3 * t);
        out.phase[k].weights[taps * i + t] = weights[t / 2 * 8 + t % 2];
      }
    }
  }
  return true;
}

/// Coefficients of two channels a lane: the first and the second, the third and nothing.
struct Row {
  __m512i pair, last, offset;
};
inline __m512i two_words(int low, int high) {
  return _mm512_set1_epi32(
      static_cast<int>((static_cast<unsigned>(low) & 0xFFFFU) | static_cast<unsigned>(high) << 16));
}
inline Row make_row(const ColourRow& m) {
  return {two_words(m.a, m.b), two_words(m.c, 0),
          _mm512_set1_epi32(m.offset * (1 << fraction_bits) + (1 << (colour_shift - 1)))};
}
/// The lower half of a, the upper half of b.
inline __m512i halves(__m512i a, __m512i b) { return _mm512_mask_blend_epi64(0xF0, a, b); }
inline Row halves(const Row& a, const Row& b) {
  return {halves(a.pair, b.pair), halves(a.last, b.last), halves(a.offset, b.offset)};
}

/// Channels of sixteen pixels in 8.6 bit: the first and the second in the words of a lane, the third in another lane.
struct Pixels {
  __m512i pair, last;
};

/// Sixteen samples of a plane.
[[gnu::always_inline]] inline __m128i samples_of(const Pixels& p, const Row& m) {
  const __m512i sums = _mm512_dpwssd_epi32(_mm512_dpwssd_epi32(m.offset, p.pair, m.pair), p.last, m.last);
  const __m512i values = _mm512_srai_epi32(sums, colour_shift);
  return _mm512_cvtusepi32_epi8(_mm512_max_epi32(values, _mm512_setzero_si512()));
}

/// What of a row's window may be read.
struct Window {
  __mmask64 low, high;
};
[[gnu::always_inline]] inline __mmask64 first_bytes(int count) {
  return count >= 64 ? ~__mmask64{0} : count <= 0 ? 0 : (__mmask64{1} << count) - 1;
}

struct Step {
  __m512i places, weights, scale;
  Window window;

  struct Sums {
    __m512i c[3];
  };
  [[gnu::always_inline]] void add(const std::uint8_t* from, Sums& sums) const {
    const __m512i low = _mm512_maskz_loadu_epi8(window.low, from);
    const __m512i high = _mm512_maskz_loadu_epi8(window.high, from + 64);
    const __m512i one = _mm512_set1_epi8(1);
    const __m512i second = _mm512_add_epi8(places, one);
    const __m512i third = _mm512_add_epi8(second, one);
    sums.c[0] = _mm512_dpbusd_epi32(sums.c[0], _mm512_permutex2var_epi8(low, places, high), weights);
    sums.c[1] = _mm512_dpbusd_epi32(sums.c[1], _mm512_permutex2var_epi8(low, second, high), weights);
    sums.c[2] = _mm512_dpbusd_epi32(sums.c[2], _mm512_permutex2var_epi8(low, third, high), weights);
  }
  /// Of two source rows. The sums fit into 16 bits.
  [[gnu::always_inline]] Pixels pixels(const std::uint8_t* a, const std::uint8_t* b) const {
    Sums sums = {};
    add(a, sums);
    add(b, sums);
    const __m512i pair = _mm512_or_si512(sums.c[0], _mm512_slli_epi32(sums.c[1], 16));
    return {_mm512_mulhi_epu16(pair, scale), _mm512_mulhi_epu16(sums.c[2], scale)};
  }
};

/// From even columns before odd ones to their order.
[[gnu::always_inline]] inline __m128i in_order(__m128i samples) {
  return _mm_unpacklo_epi8(samples, _mm_unpackhi_epi64(samples, samples));
}
/// Means over 2x2 of sums over two rows: eight, and the same eight again.
[[gnu::always_inline]] inline __m512i means(__m512i sums) {
  const __m512i four = _mm512_add_epi16(sums, _mm512_shuffle_i64x2(sums, sums, 0x4E));
  return _mm512_srli_epi16(_mm512_add_epi16(four, _mm512_set1_epi16(2)), 2);
}

/// Rows that are fetched ahead: each begins in another page, where the processor's own prefetching has to start anew.
inline constexpr int rows_ahead = 8;

/// Not to stay in the larger caches, where the working images are. The address may lie beyond the picture, where no
/// pointer may be made by counting; nothing is read.
[[gnu::always_inline]] inline void prefetch(const std::uint8_t* from, std::ptrdiff_t offset) {
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(from) + static_cast<std::uintptr_t>(offset);
  _mm_prefetch(reinterpret_cast<const char*>(address), _MM_HINT_NTA);  // NOLINT(performance-no-int-to-ptr)
}

inline void halve_frame(const HalvedFrame& given) {
  Phases phases;
  if (!make_phases(given, phases)) {
    halve_avx2::halve_frame(given);
    return;
  }
  const HalvedFrame f = given;
  const Row luma = make_row(f.matrix.y);
  const Row chroma = halves(make_row(f.matrix.cb), make_row(f.matrix.cr));
  Step step;
  step.scale = _mm512_set1_epi16(static_cast<short>(f.scale));
  for (std::ptrdiff_t i = 0; i < rows_ahead * f.source_stride; i += line_bytes) prefetch(f.source, i);
  for (int y = 0; y < f.rows; y += 2) {
    const std::uint8_t* source = f.source + 2 * y * f.source_stride;
    std::uint8_t* to = f.y + y * f.y_stride;
    std::uint8_t* cb = f.cb + y / 2 * f.cb_stride;
    std::uint8_t* cr = f.cr + y / 2 * f.cr_stride;
    int k = 0;
    for (int x = 0; x < f.columns; x += lanes) {
      const int begin = 3 * f.first_column[x];
      step.window = {first_bytes(f.source_bytes - begin), first_bytes(f.source_bytes - begin - 64)};
      step.places = _mm512_load_si512(phases.phase[k].places);
      step.weights = _mm512_load_si512(phases.phase[k].weights);
      k = k + 1 == phases.count ? 0 : k + 1;
      const std::uint8_t* from = source + begin;
      for (int i = 0; i < 4; ++i) {
        prefetch(from, (rows_ahead + i) * f.source_stride);
        prefetch(from, (rows_ahead + i) * f.source_stride + line_bytes);
      }
      const Pixels upper = step.pixels(from, from + f.source_stride);
      const Pixels lower = step.pixels(from + 2 * f.source_stride, from + 3 * f.source_stride);
      _mm_storeu_si128(reinterpret_cast<__m128i*>(to + x), in_order(samples_of(upper, luma)));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(to + f.y_stride + x), in_order(samples_of(lower, luma)));
      const Pixels mean = {means(_mm512_add_epi16(upper.pair, lower.pair)),
                           means(_mm512_add_epi16(upper.last, lower.last))};
      const __m128i both = samples_of(mean, chroma);
      _mm_storel_epi64(reinterpret_cast<__m128i*>(cb + x / 2), both);
      _mm_storel_epi64(reinterpret_cast<__m128i*>(cr + x / 2), _mm_unpackhi_epi64(both, both));
    }
  }
}

}  // namespace halve_avx512
}  // namespace
}  // namespace touchline
