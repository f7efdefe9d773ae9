// SPDX-License-Identifier: Apache-2.0
// Growing seeds inside a mask: sweeps down and up; within a row, a run of the mask that holds a seed is filled at once.
#include "vision/image/grow.h"

#include "vision/image/bit_ops.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {

/// Fills toward higher x. Adding a seed to its run carries through to the run's end, so all pixels from the seed on
/// become zero there. `carry` brings the fill over from the word before and takes it to the next.
BitWord fill_right(BitWord seeds, BitWord mask, BitWord& carry) {
  const BitWord start = seeds | (mask & carry);
  if (start == 0) {
    carry = 0;
    return 0;
  }
  const BitWord sum = mask + start;
  carry = sum < mask ? 1 : 0;
  return start | (mask & ~sum);
}

/// Fills toward lower x, in doubling steps. `carry` is bit 63 where the word after it is filled to its edge.
BitWord fill_left(BitWord seeds, BitWord mask, BitWord& carry) {
  BitWord fill = seeds | (mask & carry);
  if (fill == 0 || fill == mask) {
    carry = fill << (bits_per_word - 1);
    return fill;
  }
  BitWord through = mask;
  for (int shift = 1; shift < bits_per_word; shift *= 2) {
    fill |= through & (fill >> shift);
    through &= through >> shift;
  }
  carry = fill << (bits_per_word - 1);
  return fill;
}

void fill_runs(BitWord* seeds, const BitWord* mask, int words) {
  BitWord carry = 0;
  for (int i = 0; i < words; ++i) seeds[i] = fill_right(seeds[i], mask[i], carry);
  carry = 0;
  for (int i = words - 1; i >= 0; --i) seeds[i] = fill_left(seeds[i], mask[i], carry);
}

/// Seeds from the neighbouring row that are new in this one; true when there are any. With a long pipeline without a
/// branch a word: whether one is open is hard to foresee.
bool take_over(BitWord* seeds, const BitWord* mask, const BitWord* neighbour, int words) {
  BitWord any = 0;
  BitWord before = 0;
  BitWord here = words > 0 ? neighbour[0] : 0;
  for (int i = 0; i < words; ++i) {
    const BitWord after = i + 1 < words ? neighbour[i + 1] : 0;
    const BitWord open = mask[i] & ~seeds[i];
    if constexpr (!vector_registers) {
      if (open == 0) {
        before = here;
        here = after;
        continue;
      }
    }
    const BitWord reach = here | here << 1 | here >> 1 | before >> (bits_per_word - 1) | after << (bits_per_word - 1);
    const BitWord added = reach & open;
    seeds[i] |= added;
    any |= added;
    before = here;
    here = after;
  }
  return any != 0;
}

/// Whether a row has pixels that could be filled yet.
bool is_open(const BitWord* seeds, const BitWord* mask, int words) {
  BitWord open = 0;
  for (int i = 0; i < words; ++i) open |= mask[i] & ~seeds[i];
  return open != 0;
}

/// Rows that may be open.
struct OpenRows {
  int first = 0;
  int last = -1;
};

/// Down or up. True when something was added.
bool sweep(BitView seeds, ConstBitView mask, const OpenRows& rows, bool down) {
  const int words = words_for(mask.width);
  const int step = down ? 1 : -1;
  bool any = false;
  for (int y = down ? rows.first : rows.last; y >= rows.first && y <= rows.last; y += step) {
    if (y - step < 0 || y - step >= mask.height || !is_open(seeds.row(y), mask.row(y), words)) continue;
    if (!take_over(seeds.row(y), mask.row(y), seeds.row(y - step), words)) continue;
    fill_runs(seeds.row(y), mask.row(y), words);
    any = true;
  }
  return any;
}

/// The first sweep, down: seeds outside the mask go, and every row is filled. The rows that stay open.
OpenRows first_sweep(BitView seeds, ConstBitView mask) {
  const int words = words_for(mask.width);
  OpenRows rows;
  for (int y = 0; y < mask.height; ++y) {
    BitWord* row = seeds.row(y);
    BitWord any = 0;
    BitWord open = 0;
    for (int i = 0; i < words; ++i) {
      const BitWord here = mask.row(y)[i];
      open |= here & ~row[i];
      row[i] &= here;
      any |= row[i];
    }
    if (open == 0) continue;
    const bool more = y > 0 && take_over(row, mask.row(y), seeds.row(y - 1), words);
    if (any != 0 || more) {
      fill_runs(row, mask.row(y), words);
      if (!is_open(row, mask.row(y), words)) continue;
    }
    if (rows.last < 0) rows.first = y;
    rows.last = y;
  }
  return rows;
}

}  // namespace

GrowResult grow_inside(BitView seeds, ConstBitView mask) {
  GrowResult result;
  if (mask.width <= 0 || mask.height <= 0) return result;
  const OpenRows rows = first_sweep(seeds, mask);
  result.sweeps = 1;
  const int bound = max_grow_sweeps(mask.width, mask.height);
  // When a sweep after the first adds nothing, all rows agree with both of their neighbours.
  for (bool down = false; result.sweeps < bound; down = !down) {
    ++result.sweeps;
    if (!sweep(seeds, mask, rows, down)) return result;
  }
  result.finished = false;
  return result;
}

}  // namespace touchline
