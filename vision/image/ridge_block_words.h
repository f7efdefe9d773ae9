// SPDX-License-Identifier: Apache-2.0
// The loops of ridge_block.h for processors without vector registers: two sums of 16 bits in each word of 32, and the
// second comparison only where the first finds something (H. S. Warren, "Hacker's Delight", 2nd ed., section 2-18).
#pragma once

#include "vision/image/ridge_block_loops.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {
namespace ridge_words {

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

inline void look_along_rows(const RidgeBlock& block, const ridge::Patch& patch, const Margins& margins,
                            RidgeBits& out) {
  const int reach = ridge::longest(block.row_reach, block.row_looks);
  const int first = (ridge::margin_px - reach) & ~3;
  const int end = ridge::margin_px + px + reach;
  const std::uint8_t* rows[px + 2];
  for (int r = 0; r < px + 2; ++r) rows[r] = patch.row(block.y0 + r - 1);
  Sums<px, ridge::patch_columns> sums;
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
    const std::uint16_t* bars = sums.bar[r] + ridge::margin_px;
    for (int k = 0; k < block.row_looks; ++k) {
      compare_row(sums.sum[r] + ridge::margin_px, bars - block.row_reach[k], bars + block.row_reach[k], margins, r,
                  out.row_weak[k], out.row_strong[k]);
    }
  }
}

inline void look_along_columns(const RidgeBlock& block, const ridge::Patch& patch, const Margins& margins,
                               RidgeBits& out) {
  const int reach = ridge::longest(block.column_reach, block.column_looks);
  Sums<ridge::across_rows, px> sums;
  const bool inside = block.y0 - reach >= patch.first_row && block.y0 + px + reach <= patch.last_row;
  for (int r = max_ridge_reach_px - reach; r < max_ridge_reach_px + px + reach; ++r) {
    const int y = block.y0 - max_ridge_reach_px + r;
    const std::uint8_t* here =
        ridge::margin_px + (inside ? patch.corner + (y - patch.first_row) * patch.stride : patch.row(y));
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

inline void find_ridges(const RidgeBlock& block, RidgeBits& out) {
  ridge::Copy copy;
  const ridge::Patch patch = ridge::make_patch(block, copy);
  const auto lanes = [](int value) { return static_cast<std::uint32_t>(value) * both_lanes; };
  const Margins margins = {tops - lanes(block.weak_margin + 1), lanes(block.strong_margin - block.weak_margin)};
  if (block.row_looks > 0) look_along_rows(block, patch, margins, out);
  if (block.column_looks > 0) look_along_columns(block, patch, margins, out);
}

}  // namespace ridge_words
}  // namespace
}  // namespace touchline
