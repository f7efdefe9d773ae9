// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"
#include "vision/image/neighbour_words.h"
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
BitWord below_half_level(ImageView<const std::uint8_t> luma, int x0, int y, BitWord wanted, const Kernels& kernels) {
  BitWord below = 0;
  if (kernels.below_half_level != nullptr && y >= 2 && y + 2 < luma.height) {
    const std::uint8_t* at = luma.row(y) + x0;
    const std::ptrdiff_t stride = luma.stride;
    const bool before = y > 2 || x0 >= 2;
    const bool after =
        y + 3 < luma.height ? x0 + bits_per_word + 2 <= luma.width + stride : x0 + bits_per_word + 2 <= luma.width;
    if (before && after) {  // all that is looked at is in memory; beside the image it means nothing
      BitWord inner = wanted;
      if (x0 == 0) inner &= ~BitWord{3};
      const int end = luma.width - 2 - x0;
      if (end < bits_per_word) inner &= end > 0 ? ~(~BitWord{0} << end) : 0;
      if (inner != 0) below = kernels.below_half_level(at, stride, inner);
      wanted &= ~inner;
    }
  }
  for_each_bit(wanted, [&](int bit) {
    if (below_half_level(luma, x0 + bit, y)) below |= BitWord{1} << bit;
  });
  return below;
}

/// Sets of the pixels of `lines` those below half level.
void mark_below_half_level(ImageView<const std::uint8_t> luma, ConstBitView lines, BitView below,
                           const Kernels& kernels) {
  for (int y = 0; y < lines.height; ++y) {
    for (int i = 0; i < words_for(lines.width); ++i) {
      const BitWord word = lines.row(y)[i];
      below.row(y)[i] = word == 0 ? 0 : below_half_level(luma, i * bits_per_word, y, word, kernels);
    }
  }
}

/// Takes off the pixels that are `below` and lack a neighbour in their row or column.
void trim_border(ConstBitView below, BitView lines) {
  using Row = std::array<BitWord, words_for(max_mask_width)>;
  const int words = words_for(lines.width);
  const Row nothing = {};
  Row copies[2];
  const BitWord* above = nothing.data();  // as it was before
  for (int y = 0; y < lines.height; ++y) {
    BitWord* row = lines.row(y);
    const BitWord* dark = below.row(y);
    BitWord any = 0;
    for (int i = 0; i < words; ++i) any |= dark[i];
    if (any == 0) {
      above = row;
      continue;
    }
    const BitWord* under = y + 1 < lines.height ? lines.row(y + 1) : nothing.data();
    Row& here = copies[y % 2];
    std::copy_n(row, words, here.begin());
    for (int i = 0; i < words; ++i) {
      const RowTriple middle = row_triple(here.data(), i, words);
      row[i] &= ~dark[i] | (middle.west & middle.east & above[i] & under[i]);
    }
    above = here.data();
  }
}

/// The highest mask: bounds the steps of growing on the stack (160 bytes).
constexpr int max_mask_height = 1280;

/// The widest line of a row of blocks.
int widest(LineWidthView widths, int block_y) {
  std::uint16_t most = 0;
  for (int i = 0; i < widths.width; ++i) most = std::max(most, widths.at(i, block_y).slanted);
  return most;
}

void copy_rows(ConstBitView from, int first, int end, BitView to) {
  for (int y = first; y < end; ++y) std::copy_n(from.row(y), words_for(from.width), to.row(y));
}

/// Adds to row y the `white` pixels beside those that the lines had. True when there are any.
bool grow_row(ConstBitView white, ConstBitView before, int y, BitView lines) {
  const int words = words_for(lines.width);
  const BitWord* around[3] = {before.row(std::max(y - 1, 0)), before.row(y),
                              before.row(std::min(y + 1, before.height - 1))};
  std::array<BitWord, words_for(max_mask_width)> column;
  BitWord open = 0;
  for (int i = 0; i < words; ++i) {
    column[static_cast<std::size_t>(i)] = around[0][i] | around[1][i] | around[2][i];
    open |= white.row(y)[i] & ~around[1][i];
  }
  if (open == 0) return false;
  BitWord added = 0;
  for (int i = 0; i < words; ++i) {
    const RowTriple near = row_triple(column.data(), i, words);
    const BitWord more = (near.west | near.here | near.east) & white.row(y)[i] & ~around[1][i];
    lines.row(y)[i] |= more;
    added |= more;
  }
  return added != 0;
}

}  // namespace

void trim_to_half_level(ImageView<const std::uint8_t> luma, BitView lines, BitView scratch, const Kernels& kernels) {
  assert(lines.width <= max_mask_width);
  mark_below_half_level(luma, lines, scratch, kernels);
  for (int pass = 0; pass < 2; ++pass) {
    if (kernels.trim_border == nullptr || !kernels.trim_border(scratch, lines)) trim_border(scratch, lines);
  }
}

void grow_into_white(ConstBitView white, LineWidthView widths, BitView lines, BitView scratch, const Kernels& kernels) {
  assert(lines.width <= max_mask_width && lines.height <= max_mask_height);
  constexpr int max_steps = 16;  // half of a line of 32 px: nearer than a robot's own feet
  std::array<std::uint8_t, max_mask_height / width_block_px> steps{};  // of each row of blocks
  for (int i = 0; i < widths.height; ++i) {
    steps[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(std::min(widest(widths, i) / 32, max_steps));
  }
  if (kernels.grow_rows != nullptr && kernels.grow_rows(white, steps.data(), width_block_px, lines)) return;
  // Only rows beside one that has changed can gain: where a step finds nothing, the next one finds nothing.
  int first = 0, end = lines.height;
  for (int step = 1; step <= max_steps && first < end; ++step) {
    copy_rows(lines, std::max(first - 1, 0), std::min(end + 1, lines.height), scratch);
    int first_changed = lines.height, last_changed = -1;
    for (int y = first; y < end; ++y) {
      if (steps[static_cast<std::size_t>(y / width_block_px)] < step || !grow_row(white, scratch, y, lines)) continue;
      first_changed = std::min(first_changed, y);
      last_changed = y;
    }
    first = std::max(first_changed - 1, 0);
    end = std::min(last_changed + 2, lines.height);
  }
}

void close_lines(ConstBitView carpet, int dilate_px, int erode_px, BitView lines, BitView scratch,
                 const Kernels& kernels) {
  copy(lines, scratch);
  dilate(lines, dilate_px, kernels.join_squares);
  erode(lines, erode_px, kernels.join_squares);
  and_not_with(lines, carpet);
  or_with(lines, scratch);
}

}  // namespace touchline
