// SPDX-License-Identifier: Apache-2.0
// Averaging, subsampling and change of colours of the usual frames (HalvedFrame, kernels.h), eight working columns of
// two rows at a time. Included by files of kernels for AVX2 and later alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/kernels.h"

namespace touchline {
namespace {
namespace halve_avx2 {

inline constexpr int fraction_bits = 6;
inline constexpr int colour_shift = colour_bits + fraction_bits;

inline __m128i load(const void* from) { return _mm_loadu_si128(static_cast<const __m128i*>(from)); }
inline __m256i load_two(const std::uint8_t* low, const std::uint8_t* high) {
  return _mm256_inserti128_si256(_mm256_castsi128_si256(load(low)), load(high), 1);
}

/// Per working column (a half of the vector) the weighted sums of R, G, B over two source rows, in two parts.
inline __m256i window_sums(const std::uint8_t* a, const std::uint8_t* b, int first, int second, __m256i weights) {
  const __m256i pairs = _mm256_setr_epi8(0, 3, 1, 4, 2, 5, -1, -1, 6, 9, 7, 10, 8, 11, -1, -1,  //
                                         0, 3, 1, 4, 2, 5, -1, -1, 6, 9, 7, 10, 8, 11, -1, -1);
  const __m256i upper = _mm256_shuffle_epi8(load_two(a + first, a + second), pairs);
  const __m256i lower = _mm256_shuffle_epi8(load_two(b + first, b + second), pairs);
  return _mm256_add_epi16(_mm256_maddubs_epi16(upper, weights), _mm256_maddubs_epi16(lower, weights));
}

struct Sources {
  const std::uint8_t *a, *b;
};

/// Columns 0, 2 | 1, 3 of four, each R G B 0 in 8.6 bit.
[[gnu::always_inline]] inline __m256i four_columns(const Sources& s, const std::uint16_t* first,
                                                   const std::int8_t* weights, __m256i scale) {
  const auto* w = reinterpret_cast<const __m256i*>(weights);
  const __m256i c01 = window_sums(s.a, s.b, 3 * first[0], 3 * first[1], _mm256_loadu_si256(w));
  const __m256i c23 = window_sums(s.a, s.b, 3 * first[2], 3 * first[3], _mm256_loadu_si256(w + 1));
  const __m256i sum = _mm256_add_epi16(_mm256_unpacklo_epi64(c01, c23), _mm256_unpackhi_epi64(c01, c23));
  return _mm256_mulhi_epu16(sum, scale);
}

struct Row {
  __m256i coefficients, offset;
};
inline Row make_row(const ColourRow& m) {
  const std::int64_t lanes =
      static_cast<std::int64_t>(static_cast<std::uint64_t>(static_cast<std::uint16_t>(m.a)) |
                                static_cast<std::uint64_t>(static_cast<std::uint16_t>(m.b)) << 16 |
                                static_cast<std::uint64_t>(static_cast<std::uint16_t>(m.c)) << 32);
  return {_mm256_set1_epi64x(lanes), _mm256_set1_epi32(m.offset * (1 << fraction_bits) + (1 << (colour_shift - 1)))};
}

/// Sums in order of the columns 0 2 4 6 | 1 3 5 7.
inline __m256i luma_of(__m256i low, __m256i high, const Row& m) {
  const __m256i sums =
      _mm256_hadd_epi32(_mm256_madd_epi16(low, m.coefficients), _mm256_madd_epi16(high, m.coefficients));
  return _mm256_srai_epi32(_mm256_add_epi32(sums, m.offset), colour_shift);
}
/// Eight luma samples of each row.
inline void store_luma(__m256i upper, __m256i lower, std::uint8_t* to_upper, std::uint8_t* to_lower) {
  const __m256i words = _mm256_packs_epi32(upper, lower);
  const __m256i bytes = _mm256_packus_epi16(words, words);  // even columns of both rows | odd ones
  const __m128i rows = _mm_unpacklo_epi8(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to_upper), rows);
  _mm_storel_epi64(reinterpret_cast<__m128i*>(to_lower), _mm_unpackhi_epi64(rows, rows));
}

/// Means over 2x2 of working columns 0 and 1, 2 and 3 | 4 and 5, 6 and 7; `first` and `last` are sums of two rows.
inline __m256i four_chroma(__m256i first, __m256i last) {
  const __m256i sums =
      _mm256_add_epi16(_mm256_permute2x128_si256(first, last, 0x20), _mm256_permute2x128_si256(first, last, 0x31));
  return _mm256_srli_epi16(_mm256_add_epi16(sums, _mm256_set1_epi16(2)), 2);
}
/// Four samples of each kind; `offset` has cb's twice, then cr's.
inline void store_chroma(__m256i means, const Row& cb, const Row& cr, __m256i offset, std::uint8_t* to_cb,
                         std::uint8_t* to_cr) {
  const __m256i sums =
      _mm256_hadd_epi32(_mm256_madd_epi16(means, cb.coefficients), _mm256_madd_epi16(means, cr.coefficients));
  const __m256i v = _mm256_srai_epi32(_mm256_add_epi32(sums, offset), colour_shift);
  const __m256i words = _mm256_packs_epi32(v, v);
  const __m256i bytes = _mm256_packus_epi16(words, words);  // cb cb cr cr of the first four columns | of the last
  const __m128i both = _mm_unpacklo_epi16(_mm256_castsi256_si128(bytes), _mm256_extracti128_si256(bytes, 1));
  const std::int64_t eight = _mm_cvtsi128_si64(both);
  __builtin_memcpy(to_cb, &eight, 4);
  const std::int64_t four = eight >> 32;
  __builtin_memcpy(to_cr, &four, 4);
}

/// The address may lie beyond the picture, where no pointer may be made by counting; nothing is read.
inline void prefetch(const std::uint8_t* row, std::ptrdiff_t offset) {
  const std::uintptr_t address = reinterpret_cast<std::uintptr_t>(row) + static_cast<std::uintptr_t>(offset);
  _mm_prefetch(reinterpret_cast<const char*>(address), _MM_HINT_T0);  // NOLINT(performance-no-int-to-ptr)
}

/// Two working rows and the four source rows that they are made of.
struct HalvedRows {
  const std::uint8_t* source[4];
  int source_bytes;  // of each that may be read
  const std::uint16_t* first_column;
  const std::int8_t* weights;
  int columns, period;
  std::uint8_t* y[2];
  std::uint8_t* cb;
  std::uint8_t* cr;
};

/// Columns whose windows may be read with sixteen bytes inside the row.
inline int inner_columns(const HalvedRows& r) {
  int columns = r.columns;
  while (columns > 0 && 3 * r.first_column[columns - 1] + 16 > r.source_bytes) columns -= 8;
  return columns;
}

/// By value, so that the compiler sees that no store of bytes can change it.
struct Job {
  HalvedRows rows;
  __m256i scale;
  Row y, cb, cr;

  /// Eight working columns from x on; `shift`: where in the windows' rows the sources begin.
  [[gnu::always_inline]] void eight(const Sources& upper, const Sources& lower, const std::uint16_t* first, int x,
                                    int phase) const {
    const int next = phase + 4 >= rows.period ? phase + 4 - rows.period : phase + 4;
    const std::int8_t* weights = rows.weights + 16 * phase;
    const std::int8_t* more = rows.weights + 16 * next;
    const __m256i u0 = four_columns(upper, first, weights, scale);
    const __m256i u1 = four_columns(upper, first + 4, more, scale);
    const __m256i l0 = four_columns(lower, first, weights, scale);
    const __m256i l1 = four_columns(lower, first + 4, more, scale);
    store_luma(luma_of(u0, u1, y), luma_of(l0, l1, y), rows.y[0] + x, rows.y[1] + x);
    const __m256i means = four_chroma(_mm256_add_epi16(u0, l0), _mm256_add_epi16(u1, l1));
    store_chroma(means, cb, cr, _mm256_unpacklo_epi64(cb.offset, cr.offset), rows.cb + x / 2, rows.cr + x / 2);
  }
};

/// The last columns, on a copy with room behind it.
[[gnu::noinline]] inline void last_columns(const Job* job, int x, int phase) {
  constexpr int window_bytes = 128;  // eight columns of ratio 4 at the most, and sixteen bytes
  const HalvedRows& rows = job->rows;
  std::uint8_t copies[4][window_bytes] = {};
  std::uint16_t first[8];
  const int begin = rows.first_column[x];
  for (int i = 0; i < 8; ++i) first[i] = static_cast<std::uint16_t>(rows.first_column[x + i] - begin);
  const int left = rows.source_bytes - 3 * begin;
  const auto bytes = static_cast<std::size_t>(left < window_bytes ? left : window_bytes);
  for (int k = 0; k < 4; ++k) __builtin_memcpy(copies[k], rows.source[k] + 3 * begin, bytes);
  job->eight({copies[0], copies[1]}, {copies[2], copies[3]}, first, x, phase);
}

inline void halve_rows(const Job& of_frame) {
  const Job job = of_frame;
  const HalvedRows& r = job.rows;
  const int inner = inner_columns(r);
  int phase = 0;
  int x = 0;
  // The next four source rows: each begins in another page, where the processor's own prefetching has to start anew.
  const std::ptrdiff_t next_rows = 2 * (r.source[2] - r.source[0]);
  for (; x < inner; x += 8) {
    for (const std::uint8_t* row : r.source) prefetch(row, next_rows + 3 * r.first_column[x]);
    job.eight({r.source[0], r.source[1]}, {r.source[2], r.source[3]}, r.first_column + x, x, phase);
    phase += 8;
    while (phase >= r.period) phase -= r.period;
  }
  for (; x < r.columns; x += 8) {
    last_columns(&of_frame, x, phase);  // the address of the copy would be known to stores of bytes
    phase += 8;
    while (phase >= r.period) phase -= r.period;
  }
}

inline void halve_frame(const HalvedFrame& f) {
  Job job{{},
          _mm256_set1_epi16(static_cast<short>(f.scale)),
          make_row(f.matrix.y),
          make_row(f.matrix.cb),
          make_row(f.matrix.cr)};
  HalvedRows& rows = job.rows;
  rows.first_column = f.first_column;
  rows.weights = f.weights;
  rows.columns = f.columns;
  rows.period = f.period;
  for (int y = 0; y < f.rows; y += 2) {
    for (int k = 0; k < 4; ++k) rows.source[k] = f.source + (2 * y + k) * f.source_stride;
    const bool last = y + 2 >= f.rows;  // behind the others there is another row
    rows.source_bytes = f.source_bytes + (last ? 0 : static_cast<int>(f.source_stride));
    rows.y[0] = f.y + y * f.y_stride;
    rows.y[1] = rows.y[0] + f.y_stride;
    rows.cb = f.cb + y / 2 * f.cb_stride;
    rows.cr = f.cr + y / 2 * f.cr_stride;
    halve_rows(job);
  }
}

}  // namespace halve_avx2
}  // namespace
}  // namespace touchline
