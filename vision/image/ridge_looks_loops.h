// SPDX-License-Identifier: Apache-2.0
// What the search for ridges (ridge_search_loops.h) compares: how far to either side, sums of luma, colours, and the
// pixels on their way from one comparison to the next. Everything is local to the file that includes it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/ridge_pixels_loops.h"

namespace touchline {
namespace {
namespace ridge {

/// The steps to both sides for the four blocks of a strip, bit r for r pixels: along the row, then along the column.
using Reaches = std::uint32_t __attribute__((vector_size(32)));

/// Bit `step` where that is not too far and there was one before.
[[gnu::always_inline]] inline Reaches reach_bit(Reaches step, Reaches before) {
  constexpr std::uint32_t farthest = max_ridge_reach_px;
  const Reaches nowhere = Reaches{} + 31U;
  const Reaches place = step <= farthest ? step : nowhere;
  const Reaches bit = ((Reaches{} + 1U) << place) & 0x7FFFFFFFU;
  return before == 0U ? Reaches{} : bit;
}

/// Bit r for r steps: from a line at a right angle to the scan to one at 45 degrees in the image, and one and a half
/// pixels more for the blur; up to the first that is too far. Widths are those of line_width.h.
[[gnu::always_inline]] inline Reaches reaches_of(Reaches across, Reaches slanted) {
  const Reaches narrow = across < slanted ? across : slanted;
  const Reaches first = reach_bit((narrow * 19U / 16U + 32U) / 16U, slanted);  // no width: no ground there
  const Reaches middle = reach_bit(((narrow + slanted) / 2U + 32U) / 16U, first);
  return first | middle | reach_bit((slanted + 32U) / 16U, middle);
}

[[gnu::always_inline]] inline int first_bit(std::uint64_t bits) { return __builtin_ctzll(bits); }

/// Sums of weight 4, and what a pixel has to exceed by the margin to stand out from a side with that sum: it and a
/// sixteenth. The larger side has the larger bar, too.
template <std::size_t Rows, std::size_t Columns>
struct Sums {
  alignas(64) std::int16_t sum[Rows][Columns];
  alignas(64) std::int16_t bar[Rows][Columns];

  [[gnu::always_inline]] void set(int row, int column, const Pixels& sums) {
    sums.store(&sum[row][column]);
    with_sixteenth(sums).store(&bar[row][column]);
  }
};

struct Colour {
  std::int32_t greenness = 0, chroma = 0;
};
/// Negative where a pixel is whiter than a side. Chroma over luma, compared without a division, nor a branch, which no
/// processor could foresee: at least an eighth less green than the side, and not more of any colour: a yellow post is
/// brighter and less green than the carpet, but no line.
[[gnu::always_inline]] inline std::int32_t whiter(const Colour& here, int luma, const Colour& side, int side_luma) {
  const std::int32_t more_green = here.greenness * 8 * side_luma - side.greenness * 7 * luma;  // up to 2^28
  const std::int32_t more_colour = here.chroma * side_luma - side.chroma * luma;
  return more_green & more_colour;
}

/// Pixels that are bright enough, until they are compared in colour: the rows with any, look by look.
struct Bright {
  static constexpr int max_looks = max_ridge_reach_px - 1;  // reaches from 2 on
  std::uint32_t left[(max_looks + 1) * strip_rows];         // the first zero is behind the last
  std::uint32_t which[(max_looks + 1) * strip_rows];        // look and row, as strip_rows * look + row
  Rows strong[max_looks];
  int reach[max_looks];
  int looks = 0;
  int count = 0;

  [[gnu::always_inline]] void add(int new_reach, Rows new_left, Rows new_strong) {
    const int first = looks * strip_rows;
    reach[looks] = new_reach;
    strong[looks++] = new_strong;
#if defined(__AVX512BW__)
    const __m256i all = reinterpret_cast<__m256i>(new_left);
    const __m256i row = _mm256_add_epi32(_mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7), _mm256_set1_epi32(first));
    const __mmask8 some = _mm256_test_epi32_mask(all, all);
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(left + count), _mm256_maskz_compress_epi32(some, all));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(which + count), _mm256_maskz_compress_epi32(some, row));
    count += __builtin_popcount(some);
#else
    for (int r = 0; r < strip_rows; ++r) {
      left[count] = new_left[r];
      which[count] = static_cast<std::uint32_t>(first + r);
      count += new_left[r] != 0 ? 1 : 0;
    }
#endif
  }
};

struct Found {
  Rows weak{}, strong{};
};

}  // namespace ridge
}  // namespace
}  // namespace touchline
