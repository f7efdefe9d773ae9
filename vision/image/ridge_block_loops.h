// SPDX-License-Identifier: Apache-2.0
// The loops of ridge_block.h in the compilers' own vector notation. Included by each file of kernels alone, and
// compiled there for that file's processor: everything is local to the file.
#pragma once

#include "vision/image/ridge_block.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace touchline {
namespace {
namespace ridge {

using I16x8 = std::int16_t __attribute__((vector_size(16)));
using I16x16 = std::int16_t __attribute__((vector_size(32)));
using U8x8 = std::uint8_t __attribute__((vector_size(8)));
using U8x16 = std::uint8_t __attribute__((vector_size(16)));

inline constexpr int margin_px = 12;      // left of the block in the patch, at least the reach
inline constexpr int patch_columns = 32;  // margin, block, margin
inline constexpr int across_rows = ridge_block_px + 2 * max_ridge_reach_px;

template <typename Vector>
[[gnu::always_inline]] inline Vector load_from(const void* from) {
  Vector v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
[[gnu::always_inline]] inline I16x8 eight(const std::uint8_t* p) {
#if defined(__AVX2__)
  return reinterpret_cast<I16x8>(_mm_cvtepu8_epi16(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p))));
#elif defined(__SSE2__)
  return reinterpret_cast<I16x8>(
      _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(p)), _mm_setzero_si128()));
#else
  return __builtin_convertvector(load_from<U8x8>(p), I16x8);
#endif
}
[[gnu::always_inline]] inline I16x16 sixteen(const std::uint8_t* p) {
#if defined(__AVX2__)
  return reinterpret_cast<I16x16>(_mm256_cvtepu8_epi16(load_from<__m128i>(p)));
#else
  return __builtin_convertvector(load_from<U8x16>(p), I16x16);
#endif
}
[[gnu::always_inline]] inline I16x16 two_rows(const std::int16_t* a, const std::int16_t* b) {
#if defined(__AVX2__)
  return reinterpret_cast<I16x16>(
      _mm256_inserti128_si256(_mm256_castsi128_si256(load_from<__m128i>(a)), load_from<__m128i>(b), 1));
#else
  return __builtin_shufflevector(load_from<I16x8>(a), load_from<I16x8>(b), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                 14, 15);
#endif
}

/// A bit a lane of two vectors.
[[gnu::always_inline]] inline std::uint32_t bits_of(I16x16 first, I16x16 last) {
#if defined(__AVX2__)
  const __m256i bytes = _mm256_packs_epi16(reinterpret_cast<__m256i>(first), reinterpret_cast<__m256i>(last));
  return static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, 0xD8)));
#else
  std::uint64_t quarters[4];
  const U8x16 bytes[2] = {__builtin_convertvector(first & 1, U8x16), __builtin_convertvector(last & 1, U8x16)};
  __builtin_memcpy(quarters, bytes, sizeof bytes);
  std::uint64_t bits = 0;
  // Byte i, at bit 8 i, moves to bit 56 + i.
  for (int i = 0; i < 4; ++i) bits |= (quarters[i] * 0x0102040810204080U) >> 56 << (8 * i);
  return static_cast<std::uint32_t>(bits);
#endif
}

/// Lanes of a block, two rows a vector, that are larger than a margin.
[[gnu::always_inline]] inline std::uint64_t larger(const I16x16 (&rows)[ridge_block_px / 2], std::int16_t margin) {
  return bits_of(rows[0] > margin, rows[1] > margin) |
         static_cast<std::uint64_t>(bits_of(rows[2] > margin, rows[3] > margin)) << 32;
}

[[gnu::always_inline]] inline I16x16 larger_of(I16x16 a, I16x16 b) { return a > b ? a : b; }

/// A block's pixels, two rows a vector, and the margins they are compared with.
struct Above {
  I16x16 less_weak[ridge_block_px / 2];  // less the weak margin
  std::int16_t extra;                    // that strong asks for beyond weak
};
/// `bars`: of both sides, what a pixel has to exceed by the margin. bars(i) is asked for two rows.
template <typename Bars>
[[gnu::always_inline]] inline void compare(const Above& here, Bars bars, std::uint64_t& weak, std::uint64_t& strong) {
  I16x16 above[ridge_block_px / 2];
  for (int i = 0; i < ridge_block_px / 2; ++i) above[i] = here.less_weak[i] - bars(i);
  weak = larger(above, 0);
  strong = larger(above, here.extra);  // a branch on weak would cost more than it spares
}

inline int clamped(int v, int last) { return v < 0 ? 0 : v > last ? last : v; }

/// The block with its surroundings: in the image itself, or a copy where that reaches beyond the left or right border.
struct Patch {
  const std::uint8_t* corner = nullptr;  // of (x0 - margin_px, first row)
  std::ptrdiff_t stride = 0;
  int first_row = 0, last_row = 0;  // of the image, that may be asked for; others are replaced by the nearest of these
  [[nodiscard]] [[gnu::always_inline]] const std::uint8_t* row(int y) const {
    const int inside = y < first_row ? first_row : y > last_row ? last_row : y;
    return corner + (inside - first_row) * stride;
  }
};

inline constexpr int copied_rows = across_rows + 2;
using Copy = std::uint8_t[copied_rows][patch_columns];

inline Patch make_patch(const RidgeBlock& block, Copy& copy) {
  const int left = block.x0 - margin_px;
  const int top = clamped(block.y0 - max_ridge_reach_px, block.height - 1);
  const int bottom = clamped(block.y0 + ridge_block_px + max_ridge_reach_px, block.height - 1);
  if (left >= 0 && left + patch_columns <= block.width) return {block.luma + left, block.stride, 0, block.height - 1};
  const int first = left < 0 ? -left : 0;
  const int end = left + patch_columns > block.width ? block.width - left : patch_columns;
  for (int y = top; y <= bottom; ++y) {
    std::uint8_t* to = copy[y - top];
    for (int i = 0; i < patch_columns; ++i) to[i] = 0;
    __builtin_memcpy(to + first, block.luma + y * block.stride + left + first, static_cast<std::size_t>(end - first));
  }
  return {copy[0], patch_columns, top, bottom};
}

/// Sums of weight 4, and what a pixel has to exceed by the margin to stand out from a side with that sum: it and a
/// sixteenth. The larger side has the larger bar, too.
template <std::size_t Rows, std::size_t Columns>
struct Sums {
  std::int16_t sum[Rows][Columns];
  std::int16_t bar[Rows][Columns];

  [[gnu::always_inline]] void store(int row, int column, I16x16 sums) {
    const I16x16 bars = sums + (sums >> 4);
    __builtin_memcpy(&sum[row][column], &sums, sizeof sums);
    __builtin_memcpy(&bar[row][column], &bars, sizeof bars);
  }
};

using BlockSums = Sums<ridge_block_px, patch_columns>;

/// Sums of sixteen columns from `first` on; `above`: the row above the block.
[[gnu::always_inline]] inline void sum_down(const std::uint8_t* above, std::ptrdiff_t stride, int first,
                                            BlockSums& sums) {
  // a + 2 b + c is (a + b) + (b + c), and each pair serves two rows.
  const std::uint8_t* row = above + stride + first;
  I16x16 here = sixteen(row);
  I16x16 pair = sixteen(above + first) + here;
  for (int r = 0; r < ridge_block_px; ++r) {
    row += stride;
    const I16x16 below = sixteen(row);
    const I16x16 next = here + below;
    sums.store(r, first, pair + next);
    here = below;
    pair = next;
  }
}

inline int longest(const int (&reaches)[max_ridge_looks], int looks) {
  static_assert(max_ridge_looks == 3);
  const int last = looks > 2 && reaches[2] > reaches[1] ? reaches[2] : reaches[1];
  return looks > 1 && last > reaches[0] ? last : reaches[0];
}

inline void look_along_rows(const RidgeBlock& block, const Patch& patch, RidgeBits& out) {
  const std::uint8_t* above = patch.row(block.y0 - 1);
  std::ptrdiff_t stride = patch.stride;
  std::uint8_t at_border[ridge_block_px + 2][patch_columns];
  if (block.y0 - 1 < patch.first_row || block.y0 + ridge_block_px > patch.last_row) {
    for (int r = 0; r < ridge_block_px + 2; ++r) {
      __builtin_memcpy(at_border[r], patch.row(block.y0 + r - 1), patch_columns);
    }
    above = at_border[0];
    stride = patch_columns;
  }
  BlockSums sums;
  constexpr int middle_px = (16 - ridge_block_px) / 2;  // reach that sixteen columns have
  if (longest(block.row_reach, block.row_looks) <= middle_px) {
    sum_down(above, stride, margin_px - middle_px, sums);
  } else {
    sum_down(above, stride, 0, sums);
    sum_down(above, stride, 16, sums);
  }
  Above here;
  here.extra = static_cast<std::int16_t>(block.strong_margin - block.weak_margin);
  for (int i = 0; i < ridge_block_px / 2; ++i) {
    here.less_weak[i] = two_rows(&sums.sum[2 * i][margin_px], &sums.sum[2 * i + 1][margin_px]) - block.weak_margin;
  }
  for (int k = 0; k < block.row_looks; ++k) {
    const int reach = block.row_reach[k];
    const auto bars = [&](int i) __attribute__((always_inline)) {
      const std::int16_t* a = &sums.bar[2 * i][margin_px];
      const std::int16_t* b = &sums.bar[2 * i + 1][margin_px];
      return larger_of(two_rows(a - reach, b - reach), two_rows(a + reach, b + reach));
    };
    compare(here, bars, out.row_weak[k], out.row_strong[k]);
  }
}

/// Sums of eight pixels of two rows, each with its neighbours in the row.
[[gnu::always_inline]] inline I16x16 sum_across(const std::uint8_t* upper, const std::uint8_t* lower) {
#if defined(__AVX2__)
  // Pixels -4..11 of each: pairs of a pixel with the one before it, weighted 2 and 1; and the one after it.
  const __m256i both =
      _mm256_inserti128_si256(_mm256_castsi128_si256(load_from<__m128i>(upper - 4)), load_from<__m128i>(lower - 4), 1);
  const __m256i pairs = _mm256_setr_epi8(3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 9, 10, 10, 11, 3, 4, 4, 5, 5, 6, 6, 7, 7,
                                         8, 8, 9, 9, 10, 10, 11);
  const __m256i nexts = _mm256_setr_epi8(5, -1, 6, -1, 7, -1, 8, -1, 9, -1, 10, -1, 11, -1, 12, -1,  //
                                         5, -1, 6, -1, 7, -1, 8, -1, 9, -1, 10, -1, 11, -1, 12, -1);
  const __m256i before = _mm256_maddubs_epi16(_mm256_shuffle_epi8(both, pairs), _mm256_set1_epi16(0x0201));
  return reinterpret_cast<I16x16>(_mm256_add_epi16(before, _mm256_shuffle_epi8(both, nexts)));
#else
  const auto row = [](const std::uint8_t* here) __attribute__((always_inline)) {
    const I16x8 middle = eight(here);
    return eight(here - 1) + middle + middle + eight(here + 1);
  };
  const I16x8 a = row(upper), b = row(lower);
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#endif
}

inline void look_along_columns(const RidgeBlock& block, const Patch& patch, RidgeBits& out) {
  Sums<across_rows, ridge_block_px> sums;
  const int reach_px = longest(block.column_reach, block.column_looks);
  const int first = max_ridge_reach_px - reach_px;
  const int end = max_ridge_reach_px + ridge_block_px + reach_px;
  const int top = block.y0 - reach_px;
  if (top >= patch.first_row && top + end - first - 1 <= patch.last_row) {
    const std::uint8_t* here = patch.row(top) + margin_px;
    for (int r = first; r < end; r += 2, here += 2 * patch.stride)
      sums.store(r, 0, sum_across(here, here + patch.stride));
  } else {
    for (int r = first; r < end; r += 2) {
      const int y = top + r - first;
      sums.store(r, 0, sum_across(patch.row(y) + margin_px, patch.row(y + 1) + margin_px));
    }
  }
  Above here;
  here.extra = static_cast<std::int16_t>(block.strong_margin - block.weak_margin);
  for (int i = 0; i < ridge_block_px / 2; ++i) {
    here.less_weak[i] = load_from<I16x16>(sums.sum[max_ridge_reach_px + 2 * i]) - block.weak_margin;
  }
  for (int k = 0; k < block.column_looks; ++k) {
    const int reach = block.column_reach[k] * ridge_block_px;
    const auto bars = [&](int i) __attribute__((always_inline)) {
      const std::int16_t* middle = sums.bar[max_ridge_reach_px + 2 * i];
      return larger_of(load_from<I16x16>(middle - reach), load_from<I16x16>(middle + reach));
    };
    compare(here, bars, out.column_weak[k], out.column_strong[k]);
  }
}

inline void find_ridges(const RidgeBlock& block, RidgeBits& out) {
  Copy copy;
  const Patch patch = make_patch(block, copy);
  if (block.row_looks > 0) look_along_rows(block, patch, out);
  if (block.column_looks > 0) look_along_columns(block, patch, out);
}

}  // namespace ridge
}  // namespace
}  // namespace touchline
