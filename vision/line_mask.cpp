// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "vision/image/bit_ops.h"
#include "vision/image/half_level_loops.h"
#include "vision/image/morphology.h"
#include "vision/image/neighbour_words.h"
#include "vision/image/vector_registers.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {

/// Whether a luma is below the middle between the darkest and the brightest within two pixels, where two pixels to
/// every side lie inside.
bool inner_below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  const auto load = [](const std::uint8_t* from) {
    std::uint32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    return word;
  };
  // Five pixels of a row as two words of four.
  const std::uint8_t* left = luma.row(y - 2) + x - 2;
  std::uint32_t least = load(left);
  std::uint32_t most = least;
  for (int k = 0; k < 5; ++k, left += luma.stride) {
    const std::uint32_t first = load(left);
    const std::uint32_t last = load(left + 1);
    least = smaller_bytes(smaller_bytes(least, first), last);
    most = larger_bytes(larger_bytes(most, first), last);
  }
  return 2 * luma.at(x, y) < smallest_byte(least) + largest_byte(most);
}

/// The same anywhere.
bool below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  if (x >= 2 && y >= 2 && x + 2 < luma.width && y + 2 < luma.height) return inner_below_half_level(luma, x, y);
  const int x0 = std::max(x - 2, 0);
  const int x1 = std::min(x + 2, luma.width - 1);
  const int y1 = std::min(y + 2, luma.height - 1);
  int darkest = 255;
  int brightest = 0;
  for (int v = std::max(y - 2, 0); v <= y1; ++v) {
    const std::uint8_t* row = luma.row(v);
    for (int u = x0; u <= x1; ++u) {
      darkest = std::min<int>(darkest, row[u]);
      brightest = std::max<int>(brightest, row[u]);
    }
  }
  return 2 * luma.at(x, y) < darkest + brightest;
}

/// Of 64 pixels from x0 on the `wanted` ones below half level.
BitWord below_half_level(ImageView<const std::uint8_t> luma, int x0, int y, BitWord wanted) {
  constexpr int group_px = 16;
  BitWord below = 0;
  if constexpr (vector_registers) {
    if (y >= 2 && y + 2 < luma.height) {
      for (int i = 0; i < bits_per_word; i += group_px) {
        const BitWord group = wanted & BitWord{0xFFFF} << i;
        if (group == 0 || x0 + i < 2 || x0 + i + group_px + 2 > luma.width) continue;
        below |= group & BitWord{half_level::sixteen_below(luma, x0 + i, y)} << i;
        wanted &= ~group;
      }
    }
  }
  for_each_bit(wanted, [&](int bit) {
    if (below_half_level(luma, x0 + bit, y)) below |= BitWord{1} << bit;
  });
  return below;
}

/// Sets of the pixels of `lines` those below half level.
void mark_below_half_level(ImageView<const std::uint8_t> luma, ConstBitView lines, BitView below) {
  for (int y = 0; y < lines.height; ++y) {
    for (int i = 0; i < words_for(lines.width); ++i) {
      const BitWord word = lines.row(y)[i];
      below.row(y)[i] = word == 0 ? 0 : below_half_level(luma, i * bits_per_word, y, word);
    }
  }
}

/// Takes off the pixels that are `below` and lack a neighbour in their row or column.
void trim_border(ConstBitView below, BitView lines) {
  using Row = std::array<BitWord, words_for(max_mask_width)>;
  const int words = words_for(lines.width);
  Row rows[2] = {};  // the one above, and this one, as they were before
  for (int y = 0; y < lines.height; ++y) {
    const Row& above = rows[(y + 1) % 2];
    Row& here = rows[y % 2];
    std::copy_n(lines.row(y), words, here.begin());
    for (int i = 0; i < words; ++i) {
      const BitWord dark = below.row(y)[i];
      if (dark == 0) continue;
      const auto at = static_cast<std::size_t>(i);
      const RowTriple middle = row_triple(here.data(), i, words);
      BitWord inner = middle.west & middle.east;
      inner &= above[at];
      inner &= y + 1 < lines.height ? lines.row(y + 1)[i] : 0;
      lines.row(y)[i] &= ~dark | inner;
    }
  }
}

/// The widest line of a row of blocks.
int widest(LineWidthView widths, int block_y) {
  std::uint16_t most = 0;
  for (int i = 0; i < widths.width; ++i) most = std::max(most, widths.at(i, block_y).slanted);
  return most;
}

}  // namespace

void trim_to_half_level(ImageView<const std::uint8_t> luma, BitView lines, BitView scratch) {
  assert(lines.width <= max_mask_width);
  mark_below_half_level(luma, lines, scratch);
  for (int pass = 0; pass < 2; ++pass) trim_border(scratch, lines);
}

void grow_into_white(ConstBitView white, LineWidthView widths, BitView lines, BitView scratch) {
  constexpr int max_steps = 16;  // half of a line of 32 px: nearer than a robot's own feet
  const int words = words_for(lines.width);
  for (int step = 1; step <= max_steps; ++step) {
    BitWord added = 0;
    bool any = false;
    bool grows = false;  // the rows of this row of blocks
    copy(lines, scratch);
    for (int y = 0; y < lines.height; ++y) {
      if (y % width_block_px == 0) grows = widest(widths, std::min(y / width_block_px, widths.height - 1)) >= step * 32;
      if (!grows) continue;
      any = true;
      for (int i = 0; i < words; ++i) {
        const BitWord open = white.row(y)[i] & ~lines.row(y)[i];
        if (open == 0) continue;
        BitWord spread = 0;
        for (int dy = -1; dy <= 1; ++dy) {
          if (y + dy < 0 || y + dy >= lines.height) continue;
          const RowTriple row = row_triple(static_cast<ConstBitView>(scratch).row(y + dy), i, words);
          spread |= row.west | row.here | row.east;
        }
        lines.row(y)[i] |= spread & open;
        added |= spread & open;
      }
    }
    // The next step looks at fewer rows yet: where this one found nothing, it finds nothing.
    if (!any || added == 0) return;
  }
}

void close_lines(ConstBitView carpet, int dilate_px, int erode_px, BitView lines, BitView scratch) {
  copy(lines, scratch);
  dilate(lines, dilate_px);
  erode(lines, erode_px);
  and_not_with(lines, carpet);
  or_with(lines, scratch);
}

}  // namespace touchline
