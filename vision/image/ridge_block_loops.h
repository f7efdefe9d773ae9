// SPDX-License-Identifier: Apache-2.0
// The loops of ridge_block.h in the compilers' own vector notation. Included by each file of kernels alone, and
// compiled there for that file's processor: everything is local to the file.
#pragma once

#include "vision/image/ridge_block.h"

#if defined(__AVX2__)
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
  return __builtin_convertvector(load_from<U8x8>(p), I16x8);
}
[[gnu::always_inline]] inline I16x16 sixteen(const std::uint8_t* p) {
  return __builtin_convertvector(load_from<U8x16>(p), I16x16);
}
[[gnu::always_inline]] inline I16x16 two_rows(const std::int16_t* a, const std::int16_t* b) {
  return __builtin_shufflevector(load_from<I16x8>(a), load_from<I16x8>(b), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                 14, 15);
}

/// A bit a lane.
[[gnu::always_inline]] inline std::uint32_t bits_of(I16x16 mask) {
#if defined(__AVX2__)
  const __m256i v = reinterpret_cast<__m256i>(mask);
  const __m128i bytes = _mm_packs_epi16(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
  return static_cast<std::uint32_t>(_mm_movemask_epi8(bytes));
#else
  const U8x16 bytes = __builtin_convertvector(mask & 1, U8x16);
  std::uint64_t half[2];
  __builtin_memcpy(half, &bytes, sizeof half);
  // Byte i, at bit 8 i, moves to bit 56 + i.
  const std::uint64_t low = (half[0] * 0x0102040810204080U) >> 56;
  const std::uint64_t high = (half[1] * 0x0102040810204080U) >> 56;
  return static_cast<std::uint32_t>(low | high << 8);
#endif
}

struct Flags {
  std::uint64_t weak = 0, strong = 0;
};

/// Two rows of the block at once.
[[gnu::always_inline]] inline void compare(I16x16 here, I16x16 before, I16x16 after, const RidgeBlock& block, int row,
                                           Flags& flags) {
  const I16x16 most = before > after ? before : after;
  const I16x16 side = most + (most >> 4);
  const I16x16 above = here - side;
  flags.weak |= static_cast<std::uint64_t>(bits_of(above > block.weak_margin)) << (8 * row);
  flags.strong |= static_cast<std::uint64_t>(bits_of(above > block.strong_margin)) << (8 * row);
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

inline void look_along_rows(const RidgeBlock& block, const Patch& patch, RidgeBits& out) {
  std::int16_t sums[ridge_block_px][patch_columns];
  for (int r = 0; r < ridge_block_px; ++r) {
    const std::uint8_t* above = patch.row(block.y0 + r - 1);
    const std::uint8_t* here = patch.row(block.y0 + r);
    const std::uint8_t* below = patch.row(block.y0 + r + 1);
    for (int i = 0; i < patch_columns; i += 16) {
      const I16x16 sum = sixteen(above + i) + sixteen(here + i) + sixteen(here + i) + sixteen(below + i);
      __builtin_memcpy(&sums[r][i], &sum, sizeof sum);
    }
  }
  for (int k = 0; k < block.row_looks; ++k) {
    const int reach = block.row_reach[k];
    Flags flags;
    for (int r = 0; r < ridge_block_px; r += 2) {
      const std::int16_t* a = &sums[r][margin_px];
      const std::int16_t* b = &sums[r + 1][margin_px];
      compare(two_rows(a, b), two_rows(a - reach, b - reach), two_rows(a + reach, b + reach), block, r, flags);
    }
    out.row_weak[k] = flags.weak;
    out.row_strong[k] = flags.strong;
  }
}

inline void look_along_columns(const RidgeBlock& block, const Patch& patch, RidgeBits& out) {
  std::int16_t sums[across_rows][ridge_block_px];
  for (int r = 0; r < across_rows; ++r) {
    const std::uint8_t* here = patch.row(block.y0 - max_ridge_reach_px + r) + margin_px;
    const I16x8 sum = eight(here - 1) + eight(here) + eight(here) + eight(here + 1);
    __builtin_memcpy(sums[r], &sum, sizeof sum);
  }
  for (int k = 0; k < block.column_looks; ++k) {
    const int reach = block.column_reach[k];
    Flags flags;
    for (int r = 0; r < ridge_block_px; r += 2) {
      const std::int16_t* here = sums[max_ridge_reach_px + r];
      compare(load_from<I16x16>(here), load_from<I16x16>(here - reach * ridge_block_px),
              load_from<I16x16>(here + reach * ridge_block_px), block, r, flags);
    }
    out.column_weak[k] = flags.weak;
    out.column_strong[k] = flags.strong;
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
