// SPDX-License-Identifier: Apache-2.0
// The search for white spans (white_spans.cpp) in registers of 64 bytes: gaps are listed first, 64 pixels of a row or
// 64 columns at a time, and then judged, sixteen at a time. There are about a thousand, and whether one is a line no
// processor can guess: this way hardly a branch depends on it. Included by files of kernels for AVX-512 alone:
// everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/white_span_search.h"

namespace touchline {
namespace {
namespace spans_avx512 {

inline constexpr int word_px = 64;
inline constexpr int lanes = 16;
inline constexpr int short_lanes = 32;

// --- Gaps ------------------------------------------------------------------------------------------------------------

/// Gaps of rows, or of columns: pixels first .. end - 1.
struct GapList {
  static constexpr int room = 768;        // more than a row of max_mask_width can have
  static constexpr int behind = word_px;  // stores are of whole registers

  std::uint16_t line[room + behind];  // the row, or the column
  std::uint16_t first[room + behind];
  std::uint16_t ends[room + 1 + behind];  // of gap i in place i + 1
  std::uint16_t white[room + behind];     // pixels; of gaps of columns alone
};

[[gnu::always_inline]] inline __m512i all(std::int32_t value) { return _mm512_set1_epi32(value); }
[[gnu::always_inline]] inline __m512i all_short(int value) { return _mm512_set1_epi16(static_cast<short>(value)); }
[[gnu::always_inline]] inline void put(std::uint16_t* to, __m512i values) { _mm512_storeu_si512(to, values); }
[[gnu::always_inline]] inline __m512i get_sixteen(const std::uint16_t* from) {
  return _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}
[[gnu::always_inline]] inline int words_of(const SpanSearch& s) { return (s.width + word_px - 1) / word_px; }
[[gnu::always_inline]] inline int count(std::uint64_t bits) { return __builtin_popcountll(bits); }
/// 0, 1, 2, ...
[[gnu::always_inline]] inline __m512i counting_bytes() {
  alignas(64) std::uint8_t bytes[64];
  for (int i = 0; i < 64; ++i) bytes[i] = static_cast<std::uint8_t>(i);
  return _mm512_load_si512(bytes);
}

template <class Axis>
void judge(const SpanSearch& s, const GapList& gaps, int size, SpanCounts& counts);

struct Rows;
struct Columns;

/// Places of a word's set bits, of which there are at most 32.
[[gnu::always_inline]] inline __m512i places(std::uint64_t bits, __m512i counting, __m512i base) {
  const __m256i bytes = _mm512_castsi512_si256(_mm512_maskz_compress_epi8(bits, counting));
  return _mm512_add_epi16(_mm512_cvtepu8_epi16(bytes), base);
}

inline void search_rows(const SpanSearch& given, GapList& gaps, SpanCounts& counts) {
  const SpanSearch s = given;
  const __m512i counting = counting_bytes();
  const int words = words_of(s);
  int size = 0;
  for (int y = 0; y < s.height; ++y) {
    if (size > GapList::room - s.width / 2) {
      judge<Rows>(s, gaps, size, counts);
      size = 0;
    }
    const std::uint64_t* row = s.green + y * s.green_stride;
    int first = size;
    int end = size;  // the first one is where green begins, the end of no gap: its place is that of the gap before
    const std::uint16_t taken = gaps.ends[end];
    std::uint64_t before = 0;
    for (int i = 0; i < words; ++i) {
      const std::uint64_t left = row[i] << 1 | before;
      before = row[i] >> (word_px - 1);
      if (row[i] == left) continue;
      const __m512i base = all_short(i * word_px);
      put(gaps.first + first, places(left & ~row[i], counting, base));
      put(gaps.ends + end, places(row[i] & ~left, counting, base));
      first += count(left & ~row[i]);
      end += count(row[i] & ~left);
    }
    gaps.ends[size] = taken;
    for (int k = size; k < end; k += short_lanes) put(gaps.line + k, all_short(y));
    size = end > size ? end - 1 : size;
  }
  judge<Rows>(s, gaps, size, counts);
}

/// 32 columns of a word: where the gap began, and its white pixels so far.
struct ColumnState {
  __m512i x, first, white;

  /// Returns the list's size.
  [[gnu::always_inline]] int list(__mmask32 ended, int y, GapList& gaps, int size) const {
    put(gaps.line + size, _mm512_maskz_compress_epi16(ended, x));
    put(gaps.first + size, _mm512_maskz_compress_epi16(ended, first));
    put(gaps.white + size, _mm512_maskz_compress_epi16(ended, white));
    put(gaps.ends + size + 1, all_short(y));
    return size + count(ended);
  }
  [[gnu::always_inline]] void go_on(__mmask32 begun, __mmask32 is_white, int y) {
    first = _mm512_mask_mov_epi16(first, begun, all_short(y));
    white = _mm512_maskz_mov_epi16(~begun, white);
    white = _mm512_mask_add_epi16(white, is_white, white, all_short(1));
  }
};

inline void search_columns(const SpanSearch& given, GapList& gaps, SpanCounts& counts) {
  const SpanSearch s = given;
  const __m512i zero = _mm512_setzero_si512();
  const __m512i counting = _mm512_cvtepu8_epi16(_mm512_castsi512_si256(counting_bytes()));
  int size = 0;
  for (int i = 0; i < words_of(s); ++i) {
    ColumnState low = {_mm512_add_epi16(counting, all_short(i * word_px)), zero, zero};
    ColumnState high = {_mm512_add_epi16(low.x, all_short(short_lanes)), zero, zero};
    std::uint64_t above = 0;
    std::uint64_t had_green = 0;
    const std::uint64_t* green = s.green + i;
    const std::uint64_t* white_word = s.white + i;
    for (int y = 0; y < s.height; ++y, green += s.green_stride, white_word += s.white_stride) {
      const std::uint64_t here = *green;
      const std::uint64_t ended = here & ~above & had_green;
      const std::uint64_t begun = above & ~here;
      const std::uint64_t white = *white_word & ~here & had_green;
      above = here;
      had_green |= here;
      if (ended != 0) {
        if (size > GapList::room - word_px) {
          judge<Columns>(s, gaps, size, counts);
          size = 0;
        }
        size = low.list(static_cast<__mmask32>(ended), y, gaps, size);
        size = high.list(static_cast<__mmask32>(ended >> short_lanes), y, gaps, size);
      }
      if ((begun | white) != 0) {
        low.go_on(static_cast<__mmask32>(begun), static_cast<__mmask32>(white), y);
        high.go_on(static_cast<__mmask32>(begun >> short_lanes), static_cast<__mmask32>(white >> short_lanes), y);
      }
    }
  }
  judge<Columns>(s, gaps, size, counts);
}

// --- Judgement -------------------------------------------------------------------------------------------------------

[[gnu::always_inline]] inline bool is_set(const std::uint64_t* row, int x) {
  return (row[x / 64] >> (x % 64) & 1) != 0;
}

struct SixteenGaps {
  __m512i line, first, end, length;
  __mmask16 alive;
};

struct Rows {
  [[gnu::always_inline]] static __m512i block(const SpanSearch& s, __m512i line, __m512i middle) {
    return _mm512_add_epi32(_mm512_mullo_epi32(line, all(static_cast<int>(s.widths_stride))), middle);
  }
  [[gnu::always_inline]] static __m512i luma(const SpanSearch& s, __m512i line, __m512i at) {
    return _mm512_add_epi32(_mm512_mullo_epi32(line, all(static_cast<int>(s.luma_stride))), at);
  }
  [[gnu::always_inline]] static int step(const SpanSearch& /*s*/) { return 1; }
  [[gnu::always_inline]] static int size(const SpanSearch& s) { return s.width; }
  /// Of across_row and across_column, which lie in a lane's halves.
  [[gnu::always_inline]] static __m512i across(__m512i both) { return _mm512_and_si512(both, all(0xFFFF)); }
  [[gnu::always_inline]] static std::int64_t across(const LineWidth& width) { return width.across_row; }
  [[gnu::always_inline]] static std::int64_t other_across(const LineWidth& width) { return width.across_column; }
  [[gnu::always_inline]] static const LineWidth& width(const SpanSearch& s, int line, int middle) {
    return s.widths[line * s.widths_stride + middle];
  }
  [[gnu::always_inline]] static bool is_green(const SpanSearch& s, int middle, int line, int side) {
    return is_set(s.green + (line + side) * s.green_stride, middle);
  }
  [[gnu::always_inline]] static int other_size(const SpanSearch& s) { return s.height; }

  /// From a gap's word on, or from as far as there is memory: the bits of up to 64 pixels.
  [[gnu::always_inline]] static __m256i white_of_eight(const SpanSearch& s, __m256i bit, __m256i length) {
    const int last_word = static_cast<int>((s.height - 1) * s.white_stride) + words_of(s) - 1;
    const __m256i byte = _mm256_min_epi32(_mm256_srli_epi32(bit, 3), _mm256_set1_epi32(8 * last_word));
    const __m512i words = _mm512_i32gather_epi64(byte, s.white, 1);
    const __m512i shift = _mm512_cvtepi32_epi64(_mm256_sub_epi32(bit, _mm256_slli_epi32(byte, 3)));
    const __m512i behind = _mm512_sub_epi64(_mm512_set1_epi64(64), _mm512_cvtepi32_epi64(length));
    const __m512i bits = _mm512_sllv_epi64(_mm512_srlv_epi64(words, shift), behind);
    const __m512i table = _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
    const __m512i half_byte = _mm512_set1_epi8(15);
    const __m512i low = _mm512_shuffle_epi8(table, _mm512_and_si512(bits, half_byte));
    const __m512i high = _mm512_shuffle_epi8(table, _mm512_and_si512(_mm512_srli_epi16(bits, 4), half_byte));
    return _mm512_cvtepi64_epi32(_mm512_sad_epu8(_mm512_add_epi8(low, high), _mm512_setzero_si512()));
  }
  [[gnu::always_inline]] static __m512i white(const SpanSearch& s, const GapList& gaps, int at, const SixteenGaps& g) {
    const __m512i bit =
        _mm512_add_epi32(_mm512_mullo_epi32(g.line, all(static_cast<int>(s.white_stride) * word_px)), g.first);
    const __m256i low = white_of_eight(s, _mm512_castsi512_si256(bit), _mm512_castsi512_si256(g.length));
    const __m256i high = white_of_eight(s, _mm512_extracti64x4_epi64(bit, 1), _mm512_extracti64x4_epi64(g.length, 1));
    const __m512i white = _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
    constexpr int surely_read = 57;  // from any bit of a byte on
    const __mmask16 too_long = _mm512_mask_cmpgt_epi32_mask(g.alive, g.length, all(surely_read));
    if (too_long == 0) return white;
    alignas(64) std::int32_t counted[lanes];
    _mm512_store_si512(counted, white);
    for (int k = 0; k < lanes; ++k) {
      if ((too_long >> k & 1) == 0) continue;
      const std::uint64_t* row = s.white + gaps.line[at + k] * s.white_stride;
      counted[k] = 0;
      for (int x = gaps.first[at + k]; x < gaps.ends[at + k + 1]; ++x) counted[k] += is_set(row, x) ? 1 : 0;
    }
    return _mm512_load_si512(counted);
  }
  [[gnu::always_inline]] static void mark(const SpanSearch& s, int y, int first, int end) {
    std::uint64_t* row = s.lines + y * s.lines_stride;
    const int last = end - 1;
    const std::uint64_t left = ~std::uint64_t{0} << (first % word_px);
    const std::uint64_t right = ~std::uint64_t{0} >> (word_px - 1 - last % word_px);
    int i = first / word_px;
    if (i == last / word_px) {
      row[i] |= left & right;
      return;
    }
    row[i] |= left;
    while (++i < last / word_px) row[i] = ~std::uint64_t{0};
    row[i] |= right;
  }
};

struct Columns {
  [[gnu::always_inline]] static __m512i block(const SpanSearch& s, __m512i line, __m512i middle) {
    return Rows::block(s, middle, line);
  }
  [[gnu::always_inline]] static __m512i luma(const SpanSearch& s, __m512i line, __m512i at) {
    return Rows::luma(s, at, line);
  }
  [[gnu::always_inline]] static int step(const SpanSearch& s) { return static_cast<int>(s.luma_stride); }
  [[gnu::always_inline]] static int size(const SpanSearch& s) { return s.height; }
  [[gnu::always_inline]] static __m512i across(__m512i both) { return _mm512_srli_epi32(both, 16); }
  [[gnu::always_inline]] static std::int64_t across(const LineWidth& width) { return width.across_column; }
  [[gnu::always_inline]] static std::int64_t other_across(const LineWidth& width) { return width.across_row; }
  [[gnu::always_inline]] static const LineWidth& width(const SpanSearch& s, int line, int middle) {
    return s.widths[middle * s.widths_stride + line];
  }
  [[gnu::always_inline]] static bool is_green(const SpanSearch& s, int middle, int line, int side) {
    return is_set(s.green + middle * s.green_stride, line + side);
  }
  [[gnu::always_inline]] static int other_size(const SpanSearch& s) { return s.width; }
  [[gnu::always_inline]] static __m512i white(const SpanSearch& /*s*/, const GapList& gaps, int at,
                                              const SixteenGaps& /*g*/) {
    return get_sixteen(gaps.white + at);
  }
  /// The last pixel alone: fill_upward() does the rest.
  [[gnu::always_inline]] static void mark(const SpanSearch& s, int x, int /*first*/, int end) {
    s.lines[(end - 1) * s.lines_stride + x / word_px] |= std::uint64_t{1} << (x % word_px);
  }
};

/// A byte for each of some lanes. No byte beyond it is read, nor one before the first.
[[gnu::always_inline]] inline __m512i byte_at(__mmask16 of, const std::uint8_t* from, __m512i at) {
  const __m512i begin = _mm512_sub_epi32(_mm512_max_epi32(at, all(3)), all(3));
  const __m512i four = _mm512_mask_i32gather_epi32(_mm512_setzero_si512(), of, begin, from, 1);
  return _mm512_and_si512(_mm512_srlv_epi32(four, _mm512_slli_epi32(_mm512_sub_epi32(at, begin), 3)), all(255));
}

/// brighter_than_end() in white_spans.cpp.
[[gnu::always_inline]] inline __mmask16 brighter(const SpanSearch& s, const SixteenGaps& g, __m512i at, int outward,
                                                 __m512i available) {
  const __m512i inner = _mm512_maskz_mov_epi32(_mm512_cmpge_epi32_mask(g.length, all(4)), all(1));
  const __m512i next = _mm512_min_epi32(_mm512_add_epi32(inner, all(1)), _mm512_sub_epi32(g.length, all(1)));
  const __m512i outer = _mm512_min_epi32(available, all(2));
  const auto pixel = [&](__m512i steps) __attribute__((always_inline)) {
    return byte_at(g.alive, s.luma, _mm512_add_epi32(at, _mm512_mullo_epi32(steps, all(outward))));
  };
  const __m512i zero = _mm512_setzero_si512();
  const __m512i line = _mm512_add_epi32(pixel(_mm512_sub_epi32(zero, inner)), pixel(_mm512_sub_epi32(zero, next)));
  const __m512i green = _mm512_add_epi32(pixel(all(1)), pixel(outer));
  const __m512i excess = _mm512_sub_epi32(_mm512_sub_epi32(line, green), _mm512_srli_epi32(green, 4));
  return _mm512_mask_cmpge_epi32_mask(g.alive, excess, all(s.least_excess));
}

/// ExtentBySlope (line_extent.h) of one gap that is too wide for a line across the scan.
template <class Axis>
bool too_wide_for_slope(const SpanSearch& s, int line, int first, int end) {
  const int length = end - first, middle = (first + end) / 2;
  const LineWidth& width = Axis::width(s, line / width_block_px, middle / width_block_px);
  const std::int64_t across = Axis::across(width), other_across = Axis::other_across(width);
  const std::int64_t least = (16 * std::int64_t{length} - 40) * 4;
  const std::int64_t a = across * across, b = other_across * other_across;
  const std::int64_t rest = std::int64_t{width.slanted} * width.slanted - a - b;
  const std::int64_t mixed = rest < 0 ? 0 : rest;
  if (least * least > 25 * (a + mixed + b)) return true;
  constexpr int slope_reach = 4;
  int before = 0, behind = 0;
  while (before < length * slope_reach && line - before > 0 && !Axis::is_green(s, middle, line, -before - 1)) ++before;
  while (behind < length * slope_reach && line + behind + 1 < Axis::other_size(s) &&
         !Axis::is_green(s, middle, line, behind + 1)) {
    ++behind;
  }
  const int other = before + behind + 1;
  const std::int64_t d = other, n = length < other ? length : other;
  return least * least > 25 * (a + mixed * n / d + b * n * n / (d * d));
}

/// Judges the first `size` gaps, and marks those that are lines.
template <class Axis>
void judge(const SpanSearch& s, const GapList& gaps, int size, SpanCounts& counts) {
  SpanCounts sums;
  for (int at = 0; at < size; at += lanes) {
    SixteenGaps g;
    g.line = get_sixteen(gaps.line + at);
    g.first = get_sixteen(gaps.first + at);
    g.end = get_sixteen(gaps.ends + at + 1);
    g.length = _mm512_sub_epi32(g.end, g.first);
    g.alive = static_cast<__mmask16>(size - at >= lanes ? 0xFFFF : (1 << (size - at)) - 1);
    const auto keep = [&](__mmask16 good, int& others) __attribute__((always_inline)) {
      others += count(static_cast<__mmask16>(g.alive & ~good));
      g.alive &= good;
    };
    const __m512i middle = _mm512_srli_epi32(_mm512_add_epi32(g.first, g.end), 1);
    const __m512i block = Axis::block(s, _mm512_srli_epi32(g.line, 3), _mm512_srli_epi32(middle, 3));
    const __m512i entry = _mm512_mullo_epi32(block, all(sizeof(LineWidth)));
    const __m512i zero = _mm512_setzero_si512();
    const __m512i both = _mm512_mask_i32gather_epi32(zero, g.alive, entry, s.widths, 1);
    const __m512i last_two = _mm512_mask_i32gather_epi32(zero, g.alive, _mm512_add_epi32(entry, all(2)), s.widths, 1);
    const __m512i slanted = _mm512_srli_epi32(last_two, 16);
    const __m512i across = Axis::across(both);

    const __m512i quarters = _mm512_srli_epi32(_mm512_add_epi32(slanted, _mm512_slli_epi32(slanted, 2)), 2);
    const __m512i longest = _mm512_srli_epi32(_mm512_add_epi32(quarters, all(40)), 4);
    keep(_mm512_mask_cmple_epi32_mask(_mm512_test_epi32_mask(slanted, slanted), g.length, longest), sums.too_wide);
    keep(_mm512_cmpge_epi32_mask(_mm512_slli_epi32(g.length, 5), _mm512_sub_epi32(across, all(16))), sums.too_thin);
    const __m512i white = Axis::white(s, gaps, at, g);
    keep(_mm512_mask_cmpge_epi32_mask(_mm512_test_epi32_mask(white, white), _mm512_slli_epi32(white, 1), g.length),
         sums.not_white);
    const int step = Axis::step(s);
    const __m512i last = _mm512_sub_epi32(g.end, all(1));
    keep(brighter(s, g, Axis::luma(s, g.line, g.first), -step, g.first) &
             brighter(s, g, Axis::luma(s, g.line, last), step, _mm512_sub_epi32(all(Axis::size(s)), g.end)),
         sums.not_bright);

    // Pixels of the gap more than a line across the scan can have: 4 (16 length - 40) / 5 sixteenths.
    const __m512i least = _mm512_slli_epi32(_mm512_sub_epi32(_mm512_slli_epi32(g.length, 4), all(40)), 2);
    const __m512i five_across = _mm512_add_epi32(across, _mm512_slli_epi32(across, 2));
    const __mmask16 unsure = _mm512_mask_cmpgt_epi32_mask(g.alive, least, five_across);
    for (unsigned left = g.alive; left != 0; left &= left - 1) {
      const int k = at + __builtin_ctz(left);
      const int line = gaps.line[k], first = gaps.first[k], end = gaps.ends[k + 1];
      if ((unsure >> (k - at) & 1) != 0 && too_wide_for_slope<Axis>(s, line, first, end)) {
        ++sums.too_wide;
        continue;
      }
      ++sums.found;
      Axis::mark(s, line, first, end);
    }
  }
  counts.found += sums.found;
  counts.too_wide += sums.too_wide;
  counts.too_thin += sums.too_thin;
  counts.not_white += sums.not_white;
  counts.not_bright += sums.not_bright;
}

/// Each pixel that is marked and those above it, up to the next green one.
inline void fill_upward(const SpanSearch& s) {
  const int words = words_of(s);
  for (int y = s.height - 2; y >= 0; --y) {
    std::uint64_t* here = s.lines + y * s.lines_stride;
    const std::uint64_t* below = here + s.lines_stride;
    const std::uint64_t* green = s.green + y * s.green_stride;
    for (int i = 0; i < words; ++i) here[i] |= below[i] & ~green[i];
  }
}

inline void find_spans(const SpanSearch& s, SpanCounts& counts) {
  GapList gaps;
  gaps.ends[0] = 0;
  search_columns(s, gaps, counts);
  fill_upward(s);
  search_rows(s, gaps, counts);
}

}  // namespace spans_avx512
}  // namespace
}  // namespace touchline
