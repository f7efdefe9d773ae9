// SPDX-License-Identifier: Apache-2.0
// Which pixels of a block of 8x8 stand out in luma from what lies some pixels to both sides, for processors without
// vector registers: two sums of 16 bits in each word of 32, and the second comparison only where the first finds
// something (H. S. Warren, "Hacker's Delight", 2nd ed., section 2-18).
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/ridge_search.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {
namespace ridge_words {

inline constexpr int ridge_block_px = 8;
inline constexpr int max_ridge_looks = 3;  // along the row, and as many along the column

struct RidgeBlock {
  const std::uint8_t* luma = nullptr;  // of the image
  std::ptrdiff_t stride = 0;
  int width = 0, height = 0;  // of the image
  int x0 = 0, y0 = 0;         // of the block
  /// Steps to both sides, 1..max_ridge_reach_px.
  int row_reach[max_ridge_looks] = {}, column_reach[max_ridge_looks] = {};
  int row_looks = 0, column_looks = 0;
  /// Lumas are sums of weight 4: the pixel and its two neighbours across the look. It stands out when it is larger than
  /// the larger of both sides by a sixteenth of that and by the margin. Margins 0 to 8,192, strong at least weak.
  std::int16_t weak_margin = 0, strong_margin = 0;
};

/// Bit 8 y + x of each look. Pixels whose neighbours or sides lie outside the image mean nothing.
struct RidgeBits {
  std::uint64_t row_weak[max_ridge_looks] = {}, row_strong[max_ridge_looks] = {};
  std::uint64_t column_weak[max_ridge_looks] = {}, column_strong[max_ridge_looks] = {};
};

inline constexpr int margin_px = 12;      // left of the block in the patch, at least the reach
inline constexpr int patch_columns = 32;  // margin, block, margin
inline constexpr int across_rows = ridge_block_px + 2 * max_ridge_reach_px;

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

inline int longest(const int (&reaches)[max_ridge_looks], int looks) {
  static_assert(max_ridge_looks == 3);
  const int last = looks > 2 && reaches[2] > reaches[1] ? reaches[2] : reaches[1];
  return looks > 1 && last > reaches[0] ? last : reaches[0];
}

inline constexpr int px = ridge_block_px;
inline constexpr std::uint32_t both_lanes = 0x00010001U;
inline constexpr std::uint32_t tops = 0x80008000U;

inline std::uint32_t load_word(const void* from) {
  std::uint32_t word = 0;
  __builtin_memcpy(&word, from, sizeof word);
  return word;
}

/// Rows of sums of weight 4, and what a pixel has to exceed by the margin to stand out from a side with that sum.
template <std::size_t Rows, std::size_t Columns>
struct Sums {
  std::uint16_t sum[Rows][Columns];
  std::uint16_t bar[Rows][Columns];
};

/// Four pixels: 0 and 2, 1 and 3.
struct Four {
  std::uint32_t even, odd;
  explicit Four(const void* from) : Four(load_word(from)) {}
  explicit Four(std::uint32_t word) : even(even_bytes(word)), odd(odd_bytes(word)) {}
  Four(std::uint32_t e, std::uint32_t o) : even(e), odd(o) {}
};
inline Four operator+(const Four& a, const Four& b) { return {a.even + b.even, a.odd + b.odd}; }

/// In the order of the pixels.
inline void store_sums(const Four& four, std::uint16_t* sum, std::uint16_t* bar) {
  const std::uint32_t words[2] = {lower_halves(four.even, four.odd), upper_halves(four.even, four.odd)};
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t high = words[i] + (words[i] >> 4U & 0x0FFF0FFFU);
    __builtin_memcpy(sum + 2 * i, &words[i], sizeof high);
    __builtin_memcpy(bar + 2 * i, &high, sizeof high);
  }
}

struct Margins {
  std::uint32_t weak;   // 0x8000 less it and one: the top bit stays where a pixel is larger
  std::uint32_t extra;  // that strong asks for beyond weak
};

/// One row of the block against its sides.
inline void compare_row(const std::uint16_t* here, const std::uint16_t* before, const std::uint16_t* after,
                        const Margins& margins, int row, std::uint64_t& weak, std::uint64_t& strong) {
  std::uint32_t weak_bits = 0, strong_bits = 0;
  for (int i = 0; i < px; i += 2) {
    const std::uint32_t sum = load_word(here + i) + margins.weak;
    const std::uint32_t b = load_word(before + i), a = load_word(after + i);
    const std::uint32_t found = (sum - b) & (sum - a) & tops;
    if (found == 0) continue;
    weak_bits |= (found >> 15U & 1U) << i | (found >> 31U) << (i + 1);
    const std::uint32_t more = (sum - b - margins.extra) & (sum - a - margins.extra) & found;
    strong_bits |= (more >> 15U & 1U) << i | (more >> 31U) << (i + 1);
  }
  if (weak_bits == 0) return;
  weak |= std::uint64_t{weak_bits} << (8 * row);
  strong |= std::uint64_t{strong_bits} << (8 * row);
}

inline void look_along_rows(const RidgeBlock& block, const Patch& patch, const Margins& margins, RidgeBits& out) {
  const int reach = longest(block.row_reach, block.row_looks);
  const int first = (margin_px - reach) & ~3;
  const int end = margin_px + px + reach;
  const std::uint8_t* rows[px + 2];
  for (int r = 0; r < px + 2; ++r) rows[r] = patch.row(block.y0 + r - 1);
  Sums<px, patch_columns> sums;
  for (int i = first; i < end; i += 4) {
    // a + 2 b + c is (a + b) + (b + c), and each pair serves two rows.
    Four here(rows[1] + i);
    Four pair = Four(rows[0] + i) + here;
    for (int r = 0; r < px; ++r) {
      const Four below(rows[r + 2] + i);
      const Four next = here + below;
      store_sums(pair + next, &sums.sum[r][i], &sums.bar[r][i]);
      here = below;
      pair = next;
    }
  }
  for (int r = 0; r < px; ++r) {
    const std::uint16_t* bars = sums.bar[r] + margin_px;
    for (int k = 0; k < block.row_looks; ++k) {
      compare_row(sums.sum[r] + margin_px, bars - block.row_reach[k], bars + block.row_reach[k], margins, r,
                  out.row_weak[k], out.row_strong[k]);
    }
  }
}

inline void look_along_columns(const RidgeBlock& block, const Patch& patch, const Margins& margins, RidgeBits& out) {
  const int reach = longest(block.column_reach, block.column_looks);
  Sums<across_rows, px> sums;
  const bool inside = block.y0 - reach >= patch.first_row && block.y0 + px + reach <= patch.last_row;
  for (int r = max_ridge_reach_px - reach; r < max_ridge_reach_px + px + reach; ++r) {
    const int y = block.y0 - max_ridge_reach_px + r;
    const std::uint8_t* here =
        margin_px + (inside ? patch.corner + (y - patch.first_row) * patch.stride : patch.row(y));
    for (int i = 0; i < px; i += 4) {
      // Pixels -1, 1 | 0, 2 and 1, 3 | 2, 4: each is a neighbour or the middle of two sums.
      const Four before(here + i - 1), after(here + i + 1);
      store_sums({before.even + 2 * before.odd + after.even, before.odd + 2 * after.even + after.odd}, &sums.sum[r][i],
                 &sums.bar[r][i]);
    }
  }
  for (int k = 0; k < block.column_looks; ++k) {
    for (int r = 0; r < px; ++r) {
      const int at = max_ridge_reach_px + r;
      compare_row(sums.sum[at], sums.bar[at - block.column_reach[k]], sums.bar[at + block.column_reach[k]], margins, r,
                  out.column_weak[k], out.column_strong[k]);
    }
  }
}

inline void find_in_block(const RidgeBlock& block, RidgeBits& out) {
  Copy copy;
  const Patch patch = make_patch(block, copy);
  const auto lanes = [](int value) { return static_cast<std::uint32_t>(value) * both_lanes; };
  const Margins margins = {tops - lanes(block.weak_margin + 1), lanes(block.strong_margin - block.weak_margin)};
  if (block.row_looks > 0) look_along_rows(block, patch, margins, out);
  if (block.column_looks > 0) look_along_columns(block, patch, margins, out);
}

}  // namespace ridge_words
}  // namespace
}  // namespace touchline
