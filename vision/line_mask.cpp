// SPDX-License-Identifier: Apache-2.0
#include "vision/line_mask.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "vision/image/bit_ops.h"

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
bool inner_below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
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

/// The same anywhere.
bool below_half_level(ImageView<const std::uint8_t> luma, int x, int y) {
  if (x >= 2 && y >= 2 && x + 14 <= luma.width && y + 2 < luma.height) return inner_below_half_level(luma, x, y);
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

/// Rows of a block row whose widest line still lets `lines` grow at this step.
bool grows(LineWidthView widths, int block_y, int step) {
  for (int i = 0; i < widths.width; ++i) {
    if (widths.at(i, block_y).slanted >= step * 32) return true;
  }
  return false;
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
    copy(lines, scratch);
    for (int y = 0; y < lines.height; ++y) {
      if (!grows(widths, std::min(y / width_block_px, widths.height - 1), step)) continue;
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

}  // namespace touchline
