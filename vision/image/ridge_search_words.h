// SPDX-License-Identifier: Apache-2.0
// The search of ridge_search.h for processors without vector registers: block by block of the width table, for all
// pixels of one share their reaches.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "vision/image/ridge_block_words.h"

namespace touchline {
namespace {
namespace ridge_words {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

/// Steps to both sides at which a line of the block's width is left behind, whatever its slant: from the right angle to
/// 45 degrees in the image. One and a half pixels more for the blur. Returns how many.
inline int find_reaches(unsigned across, unsigned slanted, int (&reaches)[max_ridge_looks]) {
  constexpr unsigned farthest = max_ridge_reach_px;
  const unsigned narrow = std::min(across, slanted);
  const unsigned first = (narrow * 19 / 16 + 32) / 16;
  const unsigned middle = ((narrow + slanted) / 2 + 32) / 16;
  const unsigned last = (slanted + 32) / 16;
  // Each once, up to the first that is too far; without a branch, which no processor could foresee.
  const unsigned near_first = first <= farthest ? 1U : 0U;
  const unsigned near_middle = near_first & (middle <= farthest ? 1U : 0U);
  const unsigned near_last = near_middle & (last <= farthest ? 1U : 0U);
  reaches[0] = static_cast<int>(first);
  unsigned count = near_first;
  reaches[count] = static_cast<int>(middle);
  count += near_middle & (middle != first ? 1U : 0U);
  reaches[count] = static_cast<int>(last);
  count += near_last & (last != middle ? 1U : 0U);
  return static_cast<int>(count);
}

/// Eight rows of eight bits of a mask from (x, y) on, wherever that is: bit 8 y + x; zero beyond the image.
inline BitWord border_block_bits(ConstBitView mask, int x, int y) {
  if (x <= -8 || x >= mask.width) return 0;
  const int byte = x < 0 ? -1 : x / 8;
  const int shift = x - 8 * byte;
  const bool has_left = byte >= 0;
  const bool has_right = shift != 0 && 8 * (byte + 1) < mask.width;
  std::uint8_t rows[ridge_block_px] = {};
  const int first = std::max(-y, 0);
  const int end = std::min(mask.height - y, ridge_block_px);
  for (int r = first; r < end; ++r) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(mask.row(y + r)) + byte;
    unsigned bits = has_left ? bytes[0] : 0U;
    if (has_right) bits |= static_cast<unsigned>(bytes[1]) << 8U;
    rows[r] = static_cast<std::uint8_t>(bits >> shift);
  }
  BitWord all = 0;
  std::memcpy(&all, rows, sizeof all);
  return all;
}
inline BitWord block_bits(ConstBitView mask, int x, int y) {
  const int byte = static_cast<int>(static_cast<unsigned>(x) / 8U);
  const auto row_bytes = mask.stride * static_cast<int>(sizeof(BitWord));
  if (x < 0 || byte + 1 >= row_bytes || y < 0 || y + ridge_block_px > mask.height) return border_block_bits(mask, x, y);
  const auto* bytes = reinterpret_cast<const unsigned char*>(mask.row(y)) + byte;
  const unsigned shift = static_cast<unsigned>(x) % 8U;
  std::uint32_t halves[2] = {};
  for (int r = 0; r < ridge_block_px; ++r, bytes += row_bytes) {
    std::uint16_t two = 0;
    std::memcpy(&two, bytes, sizeof two);
    halves[r / 4] |= (static_cast<std::uint32_t>(two) >> shift & 0xFFU) << (r % 4 * 8);
  }
  return BitWord{halves[0]} | BitWord{halves[1]} << 32;
}
/// Eight blocks beside each other, from eight rows of a word: byte c of row r becomes byte r of block c.
inline void rows_to_blocks(BitWord (&words)[ridge_block_px]) {
  const auto swap = [&words](int i, int k, int shift, BitWord low) {
    const BitWord t = (words[i] >> shift ^ words[k]) & low;
    words[k] ^= t;
    words[i] ^= t << shift;
  };
  for (int i = 0; i < 4; ++i) swap(i, i + 4, 32, 0x00000000FFFFFFFFU);
  for (const int i : {0, 1, 4, 5}) swap(i, i + 2, 16, 0x0000FFFF0000FFFFU);
  for (const int i : {0, 2, 4, 6}) swap(i, i + 1, 8, 0x00FF00FF00FF00FFU);
}
/// x and y are multiples of eight.
inline void add_block(BitView mask, int x, int y, BitWord bits) {
  std::uint8_t rows[ridge_block_px];
  std::memcpy(rows, &bits, sizeof rows);
  for (int r = 0; r < ridge_block_px && y + r < mask.height; ++r) {
    unsigned char& eight = reinterpret_cast<unsigned char*>(mask.row(y + r))[x / 8];
    eight = static_cast<unsigned char>(eight | rows[r]);
  }
}
/// Pixels first <= x < end of the eight from x0 on.
inline unsigned lanes(int x0, int first, int end) {
  const int from = std::clamp(first - x0, 0, 8);
  const int to = std::clamp(end - x0, 0, 8);
  return to <= from ? 0U : ((1U << to) - 1U) & ~((1U << from) - 1U);
}
/// Pixels of a block at (x0, y0) with `inside_x` pixels to the left and the right of them, and `inside_y` above and
/// below.
inline BitWord inner_block(ConstBitView mask, int x0, int y0, int inside_x, int inside_y) {
  if (x0 >= inside_x && x0 + ridge_block_px + inside_x <= mask.width && y0 >= inside_y &&
      y0 + ridge_block_px + inside_y <= mask.height) {
    return ~BitWord{0};
  }
  const BitWord columns = BitWord{lanes(x0, inside_x, mask.width - inside_x)} * 0x0101010101010101U;
  const unsigned rows = lanes(y0, inside_y, mask.height - inside_y);
  BitWord bits = 0;
  for (int r = 0; r < ridge_block_px; ++r) bits |= ((rows >> r) & 1U) != 0 ? BitWord{0xFF} << (8 * r) : 0;
  return columns & bits;
}

class RidgeBlocks {
 public:
  explicit RidgeBlocks(const RidgeSearch& search) : s_(search) {
    block_.luma = search.image.y.data;
    block_.stride = search.image.y.stride;
    block_.width = search.image.y.width;
    block_.height = search.image.y.height;
    block_.strong_margin = search.strong_margin;
    block_.weak_margin = search.weak_margin;
  }

  /// A row of blocks of the width table.
  void search_row(int block_y) {
    const int y0 = block_y * width_block_px;
    const int rows = std::min(s_.roi.height - y0, ridge_block_px);
    for (int i = 0; i < words_for(s_.roi.width); ++i) {
      // What is a line already stays one.
      BitWord wanted[ridge_block_px] = {};
      BitWord any = 0;
      for (int r = 0; r < rows; ++r) {
        wanted[r] = s_.roi.row(y0 + r)[i] & ~s_.strong.row(y0 + r)[i];
        any |= wanted[r];
      }
      if (any == 0) continue;
      rows_to_blocks(wanted);
      const int first = i * ridge_block_px;  // as many blocks a word as bytes
      for (int k = 0; k < std::min(s_.widths.width - first, ridge_block_px); ++k) {
        const BitWord inside = inner_block(s_.roi, (first + k) * width_block_px, y0, 1, 1);
        if ((wanted[k] & inside) != 0) {
          search_block((first + k) * width_block_px, y0, s_.widths.at(first + k, block_y), wanted[k] & inside);
        }
      }
    }
  }

 private:
  struct Found {
    BitWord weak = 0, strong = 0;
  };
  struct Look {
    int x0, y0, dx, dy;
  };

  /// One block of the width table: all its pixels share the reaches.
  void search_block(int x0, int y0, const LineWidth& width, BitWord wanted) {
    if (width.slanted == 0) return;  // no ground there
    block_.row_looks = find_reaches(width.across_row, width.slanted, block_.row_reach);
    block_.column_looks = find_reaches(width.across_column, width.slanted, block_.column_reach);
    if (block_.row_looks + block_.column_looks == 0) return;
    block_.x0 = x0;
    block_.y0 = y0;
    RidgeBits bits;
    find_in_block(block_, bits);
    Found found;
    for (int k = 0; k < block_.row_looks; ++k) {
      const BitWord weak = bits.row_weak[k] & wanted;
      if (weak != 0) look({x0, y0, block_.row_reach[k], 0}, weak, bits.row_strong[k], found);
    }
    for (int k = 0; k < block_.column_looks; ++k) {
      const BitWord weak = bits.column_weak[k] & wanted;
      if (weak != 0) look({x0, y0, 0, block_.column_reach[k]}, weak, bits.column_strong[k], found);
    }
    if (found.weak == 0) return;
    add_block(s_.strong, x0, y0, found.strong);
    add_block(s_.weak, x0, y0, found.weak);
  }

  /// Of those that are bright enough, the ones between green on both sides that are whiter than these.
  void look(const Look& at, BitWord weak, BitWord strong, Found& found) const {
    // Where one is found already and cannot become more, there is nothing to learn.
    BitWord left = weak & ~(found.strong | (found.weak & ~strong));
    if (left == 0) return;
    left &= inner_block(s_.roi, at.x0, at.y0, at.dx != 0 ? at.dx : 1, at.dy != 0 ? at.dy + 1 : 1);
    left &= block_bits(s_.green, at.x0 - at.dx, at.y0 - at.dy) & block_bits(s_.green, at.x0 + at.dx, at.y0 + at.dy);
    for (; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const int x = at.x0 + bit % ridge_block_px;
      const int y = at.y0 + bit / ridge_block_px;
      const BitWord flag = BitWord{1} << bit;
      const Colour here = colour(x, y);
      // Without a branch: no processor could predict one.
      const bool before = whiter(here, colour(x - at.dx, y - at.dy));
      const bool after = whiter(here, colour(x + at.dx, y + at.dy));
      const BitWord both = static_cast<int>(before) & static_cast<int>(after) ? flag : 0;
      found.weak |= both;
      found.strong |= strong & both;
    }
  }

  struct Colour {
    std::int32_t luma, greenness, chroma;
  };
  [[nodiscard]] Colour colour(int x, int y) const {
    const int chroma = static_cast<int>(static_cast<unsigned>(y) / 2U) * s_.image.cb.stride +
                       static_cast<int>(static_cast<unsigned>(x) / 2U);
    const std::int32_t cb = s_.image.cb.data[chroma] - 128;
    const std::int32_t cr = s_.image.cr.data[chroma] - 128;
    return {s_.image.y.at(x, y), cb * s_.axis_cb + cr * s_.axis_cr, magnitude(cb) + magnitude(cr)};
  }
  /// Chroma over luma, compared without a division: at least an eighth less green than the side, and not more of any
  /// colour: a yellow post is brighter and less green than the carpet, but no line.
  static bool whiter(const Colour& here, const Colour& side) {
    const bool less_green = here.greenness * side.luma * 8 < side.greenness * here.luma * 7;
    const bool less_colour = here.chroma * side.luma < side.chroma * here.luma;
    return (static_cast<int>(less_green) & static_cast<int>(less_colour)) != 0;
  }

  RidgeSearch s_;
  RidgeBlock block_;
};

inline void find_ridges(const RidgeSearch& search) {
  RidgeBlocks blocks(search);
  for (int y = 0; y < search.widths.height; ++y) blocks.search_row(y);
}

}  // namespace ridge_words
}  // namespace
}  // namespace touchline
