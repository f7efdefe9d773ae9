// SPDX-License-Identifier: Apache-2.0
// The search of ridge_search.h in registers of 64 bytes, in columns of 32 pixels from the top down. All looks of a
// strip of eight rows are made first, without a branch; then the rows in which one found something are compared in
// colour, all their pixels at once. Included by files of kernels for AVX-512 alone: everything is local to the file.
//
// A pixel of the sum s stands out from a side of the sum b when s > b + b / 16 + margin. With n = s - margin that is
// b < n - n / 17 in integers: one limit a pixel, and sides are compared as they are.
#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "vision/image/ridge_reaches_loops.h"

namespace touchline {
namespace {
namespace ridge_avx512 {

using ridge::column_px;
using ridge::margin_px;
using ridge::strip_rows;
using ridge::window_px;

/// Rows that stay, each at its number modulo as many: a strip and the farthest steps above and below it.
inline constexpr int kept_rows = 32;
static_assert(kept_rows >= strip_rows + 2 * max_ridge_reach_px && kept_rows % strip_rows == 0);
/// The first of them come again behind the last, so that any eight in turn lie in one piece.
inline constexpr int stored_rows = kept_rows + strip_rows;
inline constexpr int most_looks = 2 * ridge::max_looks;

[[gnu::always_inline]] inline int kept(int y) { return y & (kept_rows - 1); }
[[gnu::always_inline]] inline int kept_chroma(int y) { return y & (kept_rows / 2 - 1); }

[[gnu::always_inline]] inline __m512i load(const void* from) { return _mm512_loadu_si512(from); }
[[gnu::always_inline]] inline __m512i bytes_to_16(const std::uint8_t* from) {
  return _mm512_cvtepu8_epi16(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from)));
}
/// Those of 32 bytes that are inside the image.
[[gnu::always_inline]] inline __m512i thirty_two(__mmask32 inside, const std::uint8_t* from) {
  return _mm512_cvtepu8_epi16(_mm256_maskz_loadu_epi8(inside, from));
}
[[gnu::always_inline]] inline __m512i bytes_to_32(const std::uint8_t* from) {
  return _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
}

/// What both sides of pixels with these sums have to be below. Sums up to 1020.
[[gnu::always_inline]] inline __m512i limit_of(const std::uint16_t* sums, __m512i margin) {
  const __m512i n = _mm512_subs_epu16(load(sums), margin);
  return _mm512_sub_epi16(n, _mm512_mulhi_epu16(n, _mm512_set1_epi16(3856)));  // n / 17, exact up to 4,000
}

/// A comparison of the pixels of a strip with what lies some steps to both sides of them.
struct Look {
  const std::uint16_t* here;  // sums of luma, of the first row
  const std::uint16_t* before;
  const std::uint16_t* after;
  std::ptrdiff_t pitch;  // to those of the next row
  int dx, dy;
  [[nodiscard]] [[gnu::always_inline]] __mmask32 below(__m512i limit, std::ptrdiff_t row) const {
    return _mm512_mask_cmplt_epu16_mask(_mm512_cmplt_epu16_mask(load(before + row * pitch), limit),
                                        load(after + row * pitch), limit);
  }
};

/// A row of the window, each sample twice: along the carpet's chroma, and the amount of any.
struct alignas(64) Colours {
  std::int32_t greenness[window_px];
  std::uint16_t chroma[window_px];
};

/// The search of 32 pixels of each row.
class Column {
 public:
  Column(const RidgeSearch& search, int x0) : s_(search), x0_(x0), byte_(x0 / 8) {
    const auto [inner, inside] = ridge::column_pixels(x0, search.roi.width);
    inner_ = inner;
    inside_ = inside;
    inside_chroma_ = _mm512_test_epi16_mask(_mm512_movm_epi8(inside_), _mm512_set1_epi16(-1));
    axis_ = _mm512_unpacklo_epi16(_mm512_set1_epi16(static_cast<std::int16_t>(search.axis_cb)),
                                  _mm512_set1_epi16(static_cast<std::int16_t>(search.axis_cr)));
  }

  void search() {
    for (int y0 = 0; y0 < s_.roi.height; y0 += strip_rows) search_strip(y0);
  }

 private:
  template <typename Mask>
  [[gnu::always_inline]] auto* bytes_at(const Mask& mask, int y) const {
    using Word = std::remove_reference_t<decltype(*mask.words)>;
    using Byte = std::conditional_t<std::is_const_v<Word>, const unsigned char, unsigned char>;
    return reinterpret_cast<Byte*>(mask.words + std::ptrdiff_t{mask.stride} * y) + byte_;
  }
  /// The column's pixels in rows from y0 on.
  template <typename Byte>
  struct MaskRows {
    Byte* first;
    std::ptrdiff_t stride;
    [[nodiscard]] [[gnu::always_inline]] std::uint32_t at(int r) const {
      std::uint32_t bits = 0;
      __builtin_memcpy(&bits, first + r * stride, sizeof bits);
      return bits;
    }
    [[gnu::always_inline]] void add(int r, std::uint32_t pixels) const {
      const std::uint32_t bits = at(r) | pixels;
      __builtin_memcpy(first + r * stride, &bits, sizeof bits);
    }
  };
  template <typename Mask>
  [[nodiscard]] [[gnu::always_inline]] auto rows_from(const Mask& mask, int y0) const {
    return MaskRows<std::remove_pointer_t<decltype(bytes_at(mask, y0))>>{
        bytes_at(mask, y0), mask.stride * static_cast<std::ptrdiff_t>(sizeof(BitWord))};
  }

  void search_strip(int y0) {
    // What is a line already stays one; pixels at the border have no neighbour.
    const auto roi = rows_from(s_.roi, y0);
    const auto lines = rows_from(s_.strong, y0);
    const int first = y0 < 1 ? 1 : 0;
    const int left = s_.roi.height - 1 - y0;
    alignas(32) std::uint32_t wanted[strip_rows] = {};
    if (first == 0 && left >= strip_rows) {
      for (int r = 0; r < strip_rows; ++r) wanted[r] = roi.at(r) & ~lines.at(r) & inner_;
    } else {
      for (int r = first; r < left && r < strip_rows; ++r) wanted[r] = roi.at(r) & ~lines.at(r) & inner_;
    }
    std::uint32_t any = 0;
    for (const std::uint32_t row : wanted) any |= row;
    if (any == 0) return;
    const ridge::Looks reaches = ridge::looks_at(s_.widths, x0_ / width_block_px, y0 / width_block_px);
    if ((reaches.row | reaches.column) == 0) return;
    // What is read in other pieces than it is written comes as early as may be: a load waits for stores that it
    // crosses.
    keep_rows(y0);
    keep_colours(y0);
    if (reaches.row != 0) sum_down(y0);
    const int looks = look(y0, reaches, _mm256_load_si256(reinterpret_cast<const __m256i*>(wanted)));
    compare_colours(y0, collect(looks));
  }

  /// Rows of a strip's surroundings that are not kept yet: green, luma, and luma's sums along the row. Beyond the
  /// image, where nothing is green, the nearest row serves.
  void keep_rows(int y0) {
    const int first = y0 - max_ridge_reach_px, end = y0 + strip_rows + max_ridge_reach_px;
    const int last = s_.image.y.height - 1;
    const std::ptrdiff_t stride = s_.image.y.stride;
    const std::uint8_t* image = s_.image.y.data + x0_ - margin_px;
    const std::uint64_t inside = inside_;
    const auto before = static_cast<__mmask32>(inside >> (margin_px - 1));
    const auto here = static_cast<__mmask32>(inside >> margin_px);
    const auto after = static_cast<__mmask32>(inside >> (margin_px + 1));
    for (int y = next_row_ > first ? next_row_ : first; y < end; ++y) {
      const std::uint8_t* row = image + stride * (y < 0 ? 0 : y > last ? last : y);
      const int at = kept(y);
      _mm512_store_si512(luma_[at], _mm512_maskz_loadu_epi8(inside, row));
      const __m512i middle = thirty_two(here, row + margin_px);
      const __m512i sides =
          _mm512_add_epi16(thirty_two(before, row + margin_px - 1), thirty_two(after, row + margin_px + 1));
      const __m512i sums = _mm512_add_epi16(sides, _mm512_add_epi16(middle, middle));
      std::uint64_t green = 0;
      if (y >= 1 && y < last) {  // a side at the border has no neighbour
        __builtin_memcpy(&green, bytes_at(s_.green, y) - margin_px / 8, sizeof green);
      }
      const int again = at < strip_rows ? at + kept_rows : at;
      green_[at] = green_[again] = green & inside;
      _mm512_store_si512(across_[at], sums);
      _mm512_store_si512(across_[again], sums);
    }
    next_row_ = end;
  }

  /// The strip's sums down the column.
  void sum_down(int y0) {
    const std::uint8_t* rows = luma_[kept(y0)];  // the strip's lie in one piece
    const std::uint8_t* above = luma_[kept(y0 - 1)];
    const std::uint8_t* under = luma_[kept(y0 + strip_rows)];
    for (int x = 0; x < window_px; x += column_px) {
      // a + 2 b + c is (a + b) + (b + c), and each pair serves two rows.
      __m512i here = bytes_to_16(rows + x);
      __m512i pair = _mm512_add_epi16(bytes_to_16(above + x), here);
      for (int r = 0; r < strip_rows; ++r) {
        const __m512i below = bytes_to_16((r + 1 < strip_rows ? rows + (r + 1) * window_px : under) + x);
        const __m512i next = _mm512_add_epi16(here, below);
        _mm512_store_si512(down_[r] + x, _mm512_add_epi16(pair, next));
        here = below;
        pair = next;
      }
    }
  }

  /// All looks at a strip; returns how many. Down the column first: the sums for the others were just written.
  int look(int y0, const ridge::Looks& reaches, __m256i wanted) {
    int looks = 0;
    const __m256i of_block = reinterpret_cast<__m256i>(reaches.of_block);
    const __m512i green = load(green_ + kept(y0));
    if (reaches.column != 0) {
      const std::uint16_t* sums = across_[kept(y0)];
      const Limits limits(sums, column_px, s_.weak_margin);
      for (std::uint32_t left = reaches.column; left != 0; left &= left - 1) {
        const int reach = ridge::first_bit(left);
        const int above = kept(y0 - reach), under = kept(y0 + reach);
        const __m512i sides = _mm512_and_si512(load(green_ + above), load(green_ + under));
        const __mmask8 blocks = _mm256_test_epi32_mask(of_block, _mm256_set1_epi32(1 << reach)) >> 4;
        add_look({sums, across_[above], across_[under], column_px, 0, reach}, limits, looks++,
                 _mm256_and_si256(wanted, open_pixels(sides, blocks)));
      }
    }
    if (reaches.row != 0) {
      const std::uint16_t* sums = down_[0] + margin_px;
      const Limits limits(sums, window_px, s_.weak_margin);
      for (std::uint32_t left = reaches.row; left != 0; left &= left - 1) {
        const int reach = ridge::first_bit(left);
        const __m128i by = _mm_cvtsi32_si128(reach);
        const __m512i sides = _mm512_and_si512(_mm512_sll_epi64(green, by), _mm512_srl_epi64(green, by));
        const __mmask8 blocks = _mm256_test_epi32_mask(of_block, _mm256_set1_epi32(1 << reach));
        add_look({sums, sums - reach, sums + reach, window_px, reach, 0}, limits, looks++,
                 _mm256_and_si256(wanted, open_pixels(sides, blocks)));
      }
    }
    return looks;
  }
  /// The column's part of eight windows, where a block has that look.
  [[gnu::always_inline]] static __m256i open_pixels(__m512i windows, __mmask8 blocks) {
    return _mm256_and_si256(_mm512_cvtepi64_epi32(_mm512_srli_epi64(windows, margin_px)),
                            _mm256_broadcastd_epi32(_mm_movm_epi8(blocks)));
  }
  struct Limits {
    __m512i of_row[strip_rows];
    [[gnu::always_inline]] Limits(const std::uint16_t* sums, int pitch, std::int16_t margin) {
      const __m512i margins = _mm512_set1_epi16(margin);
      for (int r = 0; r < strip_rows; ++r) of_row[r] = limit_of(sums + r * pitch, margins);
    }
  };
  [[gnu::always_inline]] void add_look(const Look& look, const Limits& limits, int i, __m256i open) {
    looks_[i] = look;
    _mm256_store_si256(reinterpret_cast<__m256i*>(open_[i]), open);
    for (int r = 0; r < strip_rows; ++r) _store_mask32(&below_[i][r], look.below(limits.of_row[r], r));
  }

  /// The rows of all looks with open pixels that stand out; returns how many. Two looks at once.
  int collect(int looks) {
    int count = 0;
    __m512i which = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    if (looks % 2 != 0) _mm256_store_si256(reinterpret_cast<__m256i*>(open_[looks]), _mm256_setzero_si256());
    for (int i = 0; i < looks; i += 2) {
      const __m512i bright = _mm512_and_si512(load(open_[i]), load(below_[i]));
      const __mmask16 some = _mm512_test_epi32_mask(bright, bright);
      _mm512_storeu_si512(bright_ + count, _mm512_maskz_compress_epi32(some, bright));
      _mm512_storeu_si512(which_ + count, _mm512_maskz_compress_epi32(some, which));
      which = _mm512_add_epi32(which, _mm512_set1_epi32(2 * strip_rows));
      count += __builtin_popcount(some);
    }
    return count;
  }

  /// Rows of chroma around the strip that are not kept yet, as wide as luma's. Beyond the image as above.
  void keep_colours(int y0) {
    constexpr int reach = max_ridge_reach_px / 2;
    const int first = y0 / 2 - reach, end = (y0 + strip_rows) / 2 + reach;
    const int last = s_.image.cb.height - 1;
    for (int y = next_colour_ > first ? next_colour_ : first; y < end; ++y) {
      const int row = y < 0 ? 0 : y > last ? last : y;
      const std::ptrdiff_t at = std::ptrdiff_t{s_.image.cb.stride} * row + (x0_ - margin_px) / 2;
      keep_colours_of(inside_chroma_, s_.image.cb.data + at, s_.image.cr.data + at, colours_[kept_chroma(y)]);
    }
    next_colour_ = end;
  }
  void keep_colours_of(__mmask32 samples, const std::uint8_t* cb, const std::uint8_t* cr, Colours& out) const {
    const __m512i grey = _mm512_set1_epi16(128);
    const __m512i b = _mm512_sub_epi16(thirty_two(samples, cb), grey);
    const __m512i r = _mm512_sub_epi16(thirty_two(samples, cr), grey);
    const __m512i chroma = _mm512_add_epi16(_mm512_abs_epi16(b), _mm512_abs_epi16(r));
    // Of each eight samples the first four, and the others.
    const __m512i first = _mm512_madd_epi16(_mm512_unpacklo_epi16(b, r), axis_);
    const __m512i last = _mm512_madd_epi16(_mm512_unpackhi_epi16(b, r), axis_);
    __m512i from = _mm512_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3, 16, 16, 17, 17, 18, 18, 19, 19);
    for (int x = 0; x < window_px; x += 16) {
      _mm512_store_si512(out.greenness + x, _mm512_permutex2var_epi32(first, from, last));
      from = _mm512_add_epi32(from, _mm512_set1_epi32(4));
    }
    const __m512i low = _mm512_cvtepu16_epi32(_mm512_castsi512_si256(chroma));
    const __m512i high = _mm512_cvtepu16_epi32(_mm512_extracti64x4_epi64(chroma, 1));
    _mm512_store_si512(out.chroma, _mm512_or_si512(low, _mm512_slli_epi32(low, 16)));
    _mm512_store_si512(out.chroma + column_px, _mm512_or_si512(high, _mm512_slli_epi32(high, 16)));
  }

  /// Of the pixels that are bright enough, the ones whiter than both sides.
  void compare_colours(int y0, int count) {
    const __m512i strong_margin = _mm512_set1_epi16(s_.strong_margin);
    std::uint32_t weak[strip_rows] = {}, strong[strip_rows] = {};
    for (int i = 0; i < count; ++i) {
      const std::uint32_t row = which_[i] % strip_rows;
      const Look& look = looks_[which_[i] / strip_rows];
      const __mmask32 found = whiter(look, y0 + static_cast<int>(row), bright_[i]);
      weak[row] |= found;
      strong[row] |= look.below(limit_of(look.here + row * look.pitch, strong_margin), row) & found;
    }
    const auto all = rows_from(s_.weak, y0);
    const auto lines = rows_from(s_.strong, y0);
    for (int r = 0; r < strip_rows && y0 + r < s_.roi.height; ++r) {
      all.add(r, weak[r]);
      lines.add(r, strong[r]);
    }
  }
  /// Chroma over luma, compared without a division: at least an eighth less green than a side, and not more of any
  /// colour: a yellow post is brighter and less green than the carpet, but no line.
  [[nodiscard]] [[gnu::always_inline]] __mmask32 whiter(const Look& look, int y, __mmask32 wanted) const {
    const std::uint8_t* luma = luma_[kept(y)] + margin_px;
    const Colours& colours = colours_[kept_chroma(y >> 1)];
    __mmask32 left = wanted;
    for (const int side : {-1, 1}) {
      const int v = y + side * look.dy, x = margin_px + side * look.dx;
      const std::uint8_t* side_luma = luma_[kept(v)] + x;
      const Colours& side_colours = colours_[kept_chroma(v >> 1)];
      left = _mm512_mask_cmplt_epu16_mask(left,
                                          _mm512_mullo_epi16(load(colours.chroma + margin_px), bytes_to_16(side_luma)),
                                          _mm512_mullo_epi16(load(side_colours.chroma + x), bytes_to_16(luma)));
      const auto less_green = [&](int i) __attribute__((always_inline)) {  // up to 2^28
        const __m512i here = bytes_to_32(luma + i);
        const __m512i eight = _mm512_slli_epi32(bytes_to_32(side_luma + i), 3);
        const __m512i seven = _mm512_sub_epi32(_mm512_slli_epi32(here, 3), here);
        return _mm512_cmplt_epi32_mask(_mm512_mullo_epi32(load(colours.greenness + margin_px + i), eight),
                                       _mm512_mullo_epi32(load(side_colours.greenness + x + i), seven));
      };
      left &= _mm512_kunpackw(less_green(16), less_green(0));
    }
    return left;
  }

  __m512i axis_;  // of the carpet's chroma, 16 bits each
  // The looks at a strip: of their rows the pixels where there are such sides, and those that stand out.
  alignas(64) std::uint32_t open_[most_looks][strip_rows], below_[most_looks][strip_rows];
  alignas(64) std::uint16_t down_[strip_rows][window_px];  // sums of luma down the column
  alignas(64) std::uint8_t luma_[kept_rows][window_px];
  alignas(64) std::uint16_t across_[stored_rows][column_px];  // and along the row
  Colours colours_[kept_rows / 2];
  const RidgeSearch& s_;
  std::uint64_t inside_;  // of the window, inside the image
  std::uint64_t green_[stored_rows];
  Look looks_[most_looks];
  int x0_;
  std::ptrdiff_t byte_;                                   // of the masks' rows
  std::uint32_t inner_;                                   // pixels of the column, but for the image's border
  std::uint32_t inside_chroma_;                           // as inside_, of the samples of chroma
  int next_row_ = -kept_rows, next_colour_ = -kept_rows;  // the first that are not kept yet
  // The rows with open pixels that stand out: the pixels; look and row, as strip_rows * look + row.
  std::uint32_t bright_[(most_looks + 2) * strip_rows], which_[(most_looks + 2) * strip_rows];
};

inline void find_ridges(const RidgeSearch& search) {
  for (int x0 = 0; x0 < search.roi.width; x0 += column_px) Column(search, x0).search();
}

}  // namespace ridge_avx512
}  // namespace
}  // namespace touchline
