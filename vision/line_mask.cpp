// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <algorithm>
#include <cstring>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"
#include "vision/image/vector_registers.h"
#include "vision/image/word_lanes.h"

namespace touchline {
namespace {

/// border = pixels of `mask` that lack a neighbour in their row or column.
void border_of(ConstBitView mask, BitView border) {
  const int words = words_for(mask.width);
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    for (int i = 0; i < words; ++i) {
      BitWord inner = row[i] << 1 | (i > 0 ? row[i - 1] >> (bits_per_word - 1) : 0);
      inner &= row[i] >> 1 | (i + 1 < words ? row[i + 1] << (bits_per_word - 1) : 0);
      inner &= y > 0 ? mask.row(y - 1)[i] : 0;
      inner &= y + 1 < mask.height ? mask.row(y + 1)[i] : 0;
      border.row(y)[i] = row[i] & ~inner;
    }
  }
}

/// Whether a luma is below the middle between the darkest and the brightest within two pixels, where sixteen bytes from
/// two pixels to the left on lie inside the row.
bool wide_below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  using U8x16 = std::uint8_t __attribute__((vector_size(16)));
  const auto load = [](const std::uint8_t* from) {
    U8x16 v;
    std::memcpy(&v, from, sizeof v);
    return v;
  };
  const std::uint8_t* corner = luma.row(y - 2) + x - 2;
  U8x16 least = load(corner);
  U8x16 most = least;
  for (int k = 1; k < 5; ++k) {
    const U8x16 row = load(corner + k * luma.stride);
    least = row < least ? row : least;
    most = row > most ? row : most;
  }
  std::uint64_t least_bytes = 0;
  std::uint64_t most_bytes = 0;
  std::memcpy(&least_bytes, &least, sizeof least_bytes);
  std::memcpy(&most_bytes, &most, sizeof most_bytes);
  int darkest = 255;
  int brightest = 0;
  for (int k = 0; k < 5; ++k) {
    darkest = std::min(darkest, static_cast<int>((least_bytes >> (8 * k)) & 0xFFU));
    brightest = std::max(brightest, static_cast<int>((most_bytes >> (8 * k)) & 0xFFU));
  }
  return 2 * luma.at(x, y) < darkest + brightest;
}

/// The same where two pixels to every side lie inside.
bool inner_below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  const auto load = [](const std::uint8_t* from) {
    std::uint32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    return word;
  };
  if constexpr (vector_registers) {
    if (x + 14 <= luma.width) return wide_below_half_level(luma, x, y);
  }
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

/// The widest line of a row of blocks.
int widest(LineWidthView widths, int block_y) {
  std::uint16_t most = 0;
  for (int i = 0; i < widths.width; ++i) most = std::max(most, widths.at(i, block_y).slanted);
  return most;
}

}  // namespace

void trim_to_half_level(ImageView<const std::uint8_t> luma, BitView lines, BitView scratch) {
  for (int pass = 0; pass < 2; ++pass) {
    border_of(lines, scratch);
    for_each_set_bit(scratch, [&](int x, int y) {
      if (below_half_level(luma, x, y)) lines.set(x, y, false);
    });
  }
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
          const BitWord* row = static_cast<ConstBitView>(scratch).row(y + dy);
          spread |= row[i] | row[i] << 1 | row[i] >> 1;
          if (i > 0) spread |= row[i - 1] >> (bits_per_word - 1);
          if (i + 1 < words) spread |= row[i + 1] << (bits_per_word - 1);
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
