// SPDX-License-Identifier: Apache-2.0
// Erosion and dilation (morphology.h) of masks of up to 512 columns: a row is a register. Included by files of kernels
// for AVX-512 alone: everything is local to the file.
#pragma once

#include <immintrin.h>

#include "vision/image/morphology.h"

namespace touchline {
namespace {
namespace squares_avx512 {

inline constexpr int most_words = 8;

/// What a mask's rows share: the words that they have, and the pixels in them.
struct Shape {
  __mmask8 words;
  __m512i inside;
};

struct Dilation {
  [[gnu::always_inline]] static __m512i outside() { return _mm512_setzero_si512(); }
  [[gnu::always_inline]] static __m512i join(__m512i a, __m512i b, __m512i c) {
    return _mm512_ternarylogic_epi64(a, b, c, 0xFE);  // any
  }
};
struct Erosion {
  [[gnu::always_inline]] static __m512i outside() { return _mm512_set1_epi64(-1); }
  [[gnu::always_inline]] static __m512i join(__m512i a, __m512i b, __m512i c) {
    return _mm512_ternarylogic_epi64(a, b, c, 0x80);  // all
  }
};

/// A row, each pixel joined with its left and its right neighbour.
template <typename Operation>
[[gnu::always_inline]] inline __m512i joined_row(const BitWord* row, const Shape& shape) {
  const __m512i outside = Operation::outside();
  const __m512i words = _mm512_maskz_loadu_epi64(shape.words, row);
  const __m512i here = _mm512_ternarylogic_epi64(shape.inside, words, outside, 0xCA);  // inside ? words : outside
  const __m512i left = _mm512_alignr_epi64(here, outside, 7);
  const __m512i right = _mm512_alignr_epi64(outside, here, 1);
  return Operation::join(_mm512_or_si512(_mm512_slli_epi64(here, 1), _mm512_srli_epi64(left, 63)), here,
                         _mm512_or_si512(_mm512_srli_epi64(here, 1), _mm512_slli_epi64(right, 63)));
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
  const int words = (mask.width + bits_per_word - 1) / bits_per_word;
  if (words > most_words) return false;
  Shape shape;
  shape.words = static_cast<__mmask8>((1 << words) - 1);
  const int used = mask.width - (words - 1) * bits_per_word;
  shape.inside =
      _mm512_mask_set1_epi64(_mm512_maskz_set1_epi64(shape.words, -1), static_cast<__mmask8>(1 << (words - 1)),
                             static_cast<std::int64_t>(~BitWord{0} >> (bits_per_word - used)));
  for (int i = 0; i < passes; ++i) {
    if (dilate) {
      pass<Dilation>(mask, shape);
    } else {
      pass<Erosion>(mask, shape);
    }
  }
  return true;
}

}  // namespace squares_avx512
}  // namespace
}  // namespace touchline
