// SPDX-License-Identifier: Apache-2.0
#include "vision/edge_zone.h"

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/neighbour_words.h"
#include "vision/line_extent.h"

namespace touchline {
namespace {

constexpr int zone_px = edge_side_px + 1;

/// The pixels of a word in whose row, or the one above or below, a mask has a pixel in the same or the next column.
BitWord beside(ConstBitView mask, int y, int i) {
  BitWord near = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, mask.height - 1); ++v) {
    const RowTriple row = row_triple(mask.row(v), i, words_for(mask.width));
    near |= row.west | row.here | row.east;
  }
  return near;
}

/// Adds to a mask all that lies within zone_px of the pixels of a word.
void add_surroundings(BitWord word, int y, int i, BitView mask) {
  static_assert(zone_px == 4, "as far as these steps reach");
  BitWord here = word | word << 1 | word >> 1;
  here |= here << 1 | here >> 1;
  here |= here << 2 | here >> 2;
  BitWord left = 0, right = 0;  // what lies in the words beside it
  for (int k = 1; k <= zone_px; ++k) {
    left |= word << (bits_per_word - k);
    right |= word >> (bits_per_word - k);
  }
  const bool has_left = left != 0 && i > 0;
  const bool has_right = right != 0 && i + 1 < words_for(mask.width);
  for (int v = std::max(y - zone_px, 0); v <= std::min(y + zone_px, mask.height - 1); ++v) {
    BitWord* row = mask.row(v);
    row[i] |= here;
    if (has_left) row[i - 1] |= left;
    if (has_right) row[i + 1] |= right;
  }
}

/// A word of a row, and the one that a search along the row reaches next.
struct WordAndNext {
  BitWord here = 0;
  BitWord next = 0;
};
/// The pixels of the word from which one of the `reach` pixels to the left is set, by doubling; 0 < reach < 64. Always
/// six steps, the last ones perhaps of length 0: reaches change from word to word.
BitWord set_to_the_left(WordAndNext mask, int reach) {
  BitWord here = mask.here << 1 | mask.next >> (bits_per_word - 1);
  BitWord next = mask.next << 1;
  for (int done = 1; done < bits_per_word; done *= 2) {
    const int step = std::clamp(reach - done, 0, done);
    here |= here << step | next >> (bits_per_word - 1 - step) >> 1;
    next |= next << step;
  }
  return here;
}
BitWord set_to_the_right(WordAndNext mask, int reach) {
  BitWord here = mask.here >> 1 | mask.next << (bits_per_word - 1);
  BitWord next = mask.next >> 1;
  for (int done = 1; done < bits_per_word; done *= 2) {
    const int step = std::clamp(reach - done, 0, done);
    here |= here >> step | next << (bits_per_word - 1 - step) << 1;
    next |= next >> step;
  }
  return here;
}

/// 64 pixels of a row.
struct Place {
  int y = 0;
  int word = 0;
};

BitWord carpet_at(const EdgeZoneInput& input, int y, int word) {
  return input.green.row(y)[word] & ~input.white.row(y)[word];
}

/// Of the pixels of a word those with carpet to the left and to the right.
BitWord between_carpet_in_row(const EdgeZoneInput& input, const Place& at, BitWord pixels, int reach) {
  const BitWord here = carpet_at(input, at.y, at.word);
  const BitWord before = at.word > 0 ? carpet_at(input, at.y, at.word - 1) : 0;
  const BitWord left = pixels & set_to_the_left({here, before}, reach);
  if (left == 0) return 0;
  const BitWord after = at.word + 1 < words_for(input.white.width) ? carpet_at(input, at.y, at.word + 1) : 0;
  return left & set_to_the_right({here, after}, reach);
}

/// And those with carpet above and below.
BitWord between_carpet_in_columns(const EdgeZoneInput& input, const Place& at, BitWord pixels, int reach) {
  BitWord above = 0, below = 0;
  const int top = std::max(at.y - reach, 0);
  for (int y = at.y - 1; y >= top; --y) above |= carpet_at(input, y, at.word);
  const BitWord left = pixels & above;
  if (left == 0) return 0;
  const int bottom = std::min(at.y + reach, input.white.height - 1);
  for (int y = at.y + 1; y <= bottom; ++y) below |= carpet_at(input, y, at.word);
  return left & below;
}

/// Of the white of a word what may belong to a line.
BitWord between_carpet(const EdgeZoneInput& input, const Place& at, BitWord white) {
  const int reach = longest_step(input.widths, at.y, at.word, white);
  if (reach >= bits_per_word) return white;  // the words beside it do not tell
  const BitWord in_row = between_carpet_in_row(input, at, white, reach);
  return in_row | between_carpet_in_columns(input, at, white & ~in_row, reach);
}

}  // namespace

void find_edge_zone(const EdgeZoneInput& input, BitView zone) {
  clear(zone);
  for (int y = 0; y < zone.height; ++y) {
    for (int i = 0; i < words_for(zone.width); ++i) {
      BitWord open = input.white.row(y)[i] & input.region.row(y)[i];
      if (open == 0) continue;
      open &= ~beside(input.lines, y, i);
      if (open != 0) open = between_carpet(input, {y, i}, open);
      if (open != 0) add_surroundings(open, y, i, zone);
    }
  }
  and_with(zone, input.region);
}

}  // namespace touchline
