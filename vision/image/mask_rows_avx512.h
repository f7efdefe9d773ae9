// SPDX-License-Identifier: Apache-2.0
// What looks at the neighbours of a mask's pixels, for masks of up to 512 columns: a row is a register. Included by
// files of kernels for AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/kernels.h"

namespace touchline {
namespace {
namespace mask_avx512 {

inline constexpr int most_words = 8;

/// What a mask's rows share: the words that they have, and the pixels in them.
struct Shape {
  __mmask8 words;
  __m512i inside;
};

/// False when the mask is too wide, or empty.
[[gnu::always_inline]] inline bool shape_of(const BitView& mask, Shape& shape) {
  const int words = (mask.width + bits_per_word - 1) / bits_per_word;
  if (words < 1 || words > most_words) return false;
  shape.words = static_cast<__mmask8>((1 << words) - 1);
  const int used = mask.width - (words - 1) * bits_per_word;
  shape.inside =
      _mm512_mask_set1_epi64(_mm512_maskz_set1_epi64(shape.words, -1), static_cast<__mmask8>(1 << (words - 1)),
                             static_cast<std::int64_t>(~BitWord{0} >> (bits_per_word - used)));
  return true;
}

/// Row y; nothing outside the image.
template <typename Mask>
[[gnu::always_inline]] inline __m512i row_of(const Mask& mask, int y, const Shape& shape) {
  if (y < 0 || y >= mask.height) return _mm512_setzero_si512();
  return _mm512_maskz_loadu_epi64(shape.words, mask.words + std::ptrdiff_t{mask.stride} * y);
}
[[gnu::always_inline]] inline void set_row(const BitView& mask, int y, const Shape& shape, __m512i row) {
  _mm512_mask_storeu_epi64(mask.words + std::ptrdiff_t{mask.stride} * y, shape.words, row);
}
/// Each pixel's left neighbour, and its right one; `outside` has those beyond the ends.
[[gnu::always_inline]] inline __m512i left_of(__m512i row, __m512i outside) {
  const __m512i before = _mm512_alignr_epi64(row, outside, 7);
  return _mm512_or_si512(_mm512_slli_epi64(row, 1), _mm512_srli_epi64(before, 63));
}
[[gnu::always_inline]] inline __m512i right_of(__m512i row, __m512i outside) {
  const __m512i after = _mm512_alignr_epi64(outside, row, 1);
  return _mm512_or_si512(_mm512_srli_epi64(row, 1), _mm512_slli_epi64(after, 63));
}
[[gnu::always_inline]] inline __m512i any_of(__m512i a, __m512i b, __m512i c) {
  return _mm512_ternarylogic_epi64(a, b, c, 0xFE);
}
[[gnu::always_inline]] inline __m512i all_of(__m512i a, __m512i b, __m512i c) {
  return _mm512_ternarylogic_epi64(a, b, c, 0x80);
}

struct Dilation {
  [[gnu::always_inline]] static __m512i outside() { return _mm512_setzero_si512(); }
  [[gnu::always_inline]] static __m512i join(__m512i a, __m512i b, __m512i c) { return any_of(a, b, c); }
};
struct Erosion {
  [[gnu::always_inline]] static __m512i outside() { return _mm512_set1_epi64(-1); }
  [[gnu::always_inline]] static __m512i join(__m512i a, __m512i b, __m512i c) { return all_of(a, b, c); }
};

/// A row, each pixel joined with its left and its right neighbour.
template <typename Operation>
[[gnu::always_inline]] inline __m512i joined_row(const BitWord* row, const Shape& shape) {
  const __m512i outside = Operation::outside();
  const __m512i words = _mm512_maskz_loadu_epi64(shape.words, row);
  const __m512i here = _mm512_ternarylogic_epi64(shape.inside, words, outside, 0xCA);  // inside ? words : outside
  return Operation::join(left_of(here, outside), here, right_of(here, outside));
}

template <typename Operation>
[[gnu::always_inline]] inline void pass(BitView mask, const Shape& shape) {
  __m512i above = Operation::outside();
  __m512i here = joined_row<Operation>(mask.words, shape);
  BitWord* row = mask.words;
  for (int y = 1; y <= mask.height; ++y, row += mask.stride) {
    const __m512i below = y < mask.height ? joined_row<Operation>(row + mask.stride, shape) : Operation::outside();
    const __m512i joined = Operation::join(above, here, below);
    _mm512_mask_storeu_epi64(row, shape.words, _mm512_and_si512(joined, shape.inside));
    above = here;
    here = below;
  }
}

inline bool join_squares(BitView mask, bool dilate, int passes) {
  Shape shape;
  if (!shape_of(mask, shape)) return false;
  for (int i = 0; i < passes; ++i) {
    if (dilate) {
      pass<Dilation>(mask, shape);
    } else {
      pass<Erosion>(mask, shape);
    }
  }
  return true;
}

/// Kernels::grow_rows.
inline bool grow_rows(ConstBitView inside, const std::uint8_t* steps_of_rows, int rows_a_number, BitView mask) {
  Shape shape;
  if (!shape_of(mask, shape)) return false;
  const __m512i zero = _mm512_setzero_si512();
  // Only rows beside one that has changed can gain: where a step finds nothing, the next one finds nothing.
  int first = 0, end = mask.height;
  for (int step = 1;; ++step) {
    int first_changed = 0, last_changed = -1;
    __m512i above = row_of(mask, first - 1, shape), here = row_of(mask, first, shape);  // as they were before
    for (int y = first; y < end; ++y) {
      const __m512i below = row_of(mask, y + 1, shape);
      const __m512i column = any_of(above, here, below);
      above = here;
      here = below;
      if (steps_of_rows[y / rows_a_number] < step) continue;
      const __m512i near = any_of(left_of(column, zero), column, right_of(column, zero));
      const __m512i open = _mm512_andnot_si512(above, row_of(inside, y, shape));
      if (_mm512_test_epi64_mask(near, open) == 0) continue;
      set_row(mask, y, shape, _mm512_or_si512(above, _mm512_and_si512(near, open)));
      if (last_changed < 0) first_changed = y;
      last_changed = y;
    }
    if (last_changed < 0) break;
    first = first_changed > 0 ? first_changed - 1 : 0;
    end = last_changed + 2 < mask.height ? last_changed + 2 : mask.height;
  }
  return true;
}

/// Kernels::trim_border.
inline bool trim_border(ConstBitView loose, BitView mask) {
  Shape shape;
  if (!shape_of(mask, shape)) return false;
  const __m512i zero = _mm512_setzero_si512();
  __m512i above = zero, here = row_of(mask, 0, shape);  // as they were before
  for (int y = 0; y < mask.height; ++y) {
    const __m512i below = row_of(mask, y + 1, shape);
    const __m512i between = all_of(left_of(here, zero), right_of(here, zero), _mm512_and_si512(above, below));
    const __m512i border = _mm512_andnot_si512(between, row_of(loose, y, shape));
    set_row(mask, y, shape, _mm512_andnot_si512(border, here));
    above = here;
    here = below;
  }
  return true;
}

}  // namespace mask_avx512
}  // namespace
}  // namespace touchline
