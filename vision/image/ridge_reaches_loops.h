// SPDX-License-Identifier: Apache-2.0
// How far to either side the search for ridges looks, in the blocks of a strip of 32 x 8 pixels. Everything is local to
// the file that includes it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/ridge_search.h"

namespace touchline {
namespace {
namespace ridge {

/// A column of the image is `column_px` wide, four blocks of the width table; a strip of it has as many rows as those.
inline constexpr int column_px = 32;
inline constexpr int strip_rows = width_block_px;
/// The window: from `margin_px` to the left of the column to as many to its right.
inline constexpr int margin_px = 16;
inline constexpr int window_px = column_px + 2 * margin_px;
static_assert(margin_px >= max_ridge_reach_px && window_px == 64);

/// Of an image `width` pixels wide, for the column from x0 on.
struct ColumnPixels {
  std::uint32_t inner;   // of the column: those with neighbours on both sides
  std::uint64_t inside;  // of the window: those inside the image
};
[[gnu::always_inline]] inline ColumnPixels column_pixels(int x0, int width) {
  const int first = x0 < 1 ? 1 : 0;
  const int left = width - x0;
  const int end = left - 1 < column_px ? left - 1 : column_px;
  const std::uint64_t inner = end <= first ? 0 : (std::uint64_t{1} << end) - (std::uint64_t{1} << first);
  std::uint64_t inside = ~std::uint64_t{0};
  if (x0 == 0) inside <<= margin_px;
  if (left + margin_px < window_px) inside &= (std::uint64_t{1} << (left + margin_px)) - 1;
  return {static_cast<std::uint32_t>(inner), inside};
}

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
inline constexpr int max_looks = max_ridge_reach_px - 1;  // along the row or the column: reaches from 2 on

[[gnu::always_inline]] inline int first_bit(std::uint64_t bits) { return __builtin_ctzll(bits); }

/// The reaches of the four blocks of a strip.
struct Looks {
  std::uint32_t row = 0, column = 0;  // of all blocks
  Reaches of_block;
};

/// Those of the strip whose first pixel is in a column and a row of blocks.
[[gnu::always_inline]] inline Looks looks_at(const ImageView<const LineWidth>& table, int block_x, int block_y) {
  constexpr int blocks = column_px / width_block_px;
  using U16x16 = std::uint16_t __attribute__((vector_size(32)));
  static_assert(sizeof(LineWidth) == 3 * sizeof(std::uint16_t));
  LineWidth widths[blocks] = {};
  const int left = table.width - block_x;
  const LineWidth* from = table.data + std::ptrdiff_t{table.stride} * block_y + block_x;
  U16x16 v{};
  // With what follows in the memory: a vector that is made of parts has to wait for them.
  const std::ptrdiff_t behind = std::ptrdiff_t{table.stride} * (table.height - 1 - block_y) + left;
  if (left >= blocks && behind * static_cast<std::ptrdiff_t>(sizeof(LineWidth)) >= std::ptrdiff_t{sizeof v}) {
    __builtin_memcpy(&v, from, sizeof v);
  } else {
    for (int i = 0; i < (left < blocks ? left : blocks); ++i) widths[i] = from[i];
    __builtin_memcpy(&v, widths, sizeof widths);
  }
  const auto across = __builtin_shufflevector(v, v, 0, 3, 6, 9, 1, 4, 7, 10);
  const auto slanted = __builtin_shufflevector(v, v, 2, 5, 8, 11, 2, 5, 8, 11);
  Looks looks;
  looks.of_block = reaches_of(__builtin_convertvector(across, Reaches), __builtin_convertvector(slanted, Reaches));
  const Reaches two = looks.of_block | __builtin_shufflevector(looks.of_block, looks.of_block, 2, 3, 0, 1, 6, 7, 4, 5);
  looks.row = two[0] | two[1];
  looks.column = two[blocks] | two[blocks + 1];
  return looks;
}

}  // namespace ridge
}  // namespace
}  // namespace touchline
