// SPDX-License-Identifier: Apache-2.0
// Growing seeds inside a mask: sweeps down and up; within a row, a run of the mask that holds a seed is filled at once.
#include "vision/image/grow.h"

#include "vision/image/bit_ops.h"

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

/// Seeds from the neighbouring row that are new in this one; true when there are any.
bool take_over(BitWord* seeds, const BitWord* mask, const BitWord* neighbour, int words) {
  BitWord any = 0;
  BitWord before = 0;
  for (int i = 0; i < words; ++i) {
    const BitWord here = neighbour[i];
    const BitWord open = mask[i] & ~seeds[i];
    if (open == 0) {
      before = here;
      continue;
    }
    const BitWord after = i + 1 < words ? neighbour[i + 1] : 0;
    const BitWord reach = here | here << 1 | here >> 1 | before >> (bits_per_word - 1) | after << (bits_per_word - 1);
    const BitWord added = reach & open;
    seeds[i] |= added;
    any |= added;
    before = here;
  }
  return any != 0;
}

/// From row `from` in steps of `step`. True when something was added.
bool sweep(BitView seeds, ConstBitView mask, int from, int step) {
  const int words = words_for(mask.width);
  bool any = false;
  for (int y = from + step; y >= 0 && y < mask.height; y += step) {
    if (!take_over(seeds.row(y), mask.row(y), seeds.row(y - step), words)) continue;
    fill_runs(seeds.row(y), mask.row(y), words);
    any = true;
  }
  return any;
}

}  // namespace

GrowResult grow_inside(BitView seeds, ConstBitView mask) {
  GrowResult result;
  if (mask.width <= 0 || mask.height <= 0) return result;
  and_with(seeds, mask);
  for (int y = 0; y < mask.height; ++y) fill_runs(seeds.row(y), mask.row(y), words_for(mask.width));
  const int bound = max_grow_sweeps(mask.width, mask.height);
  // When the second of two sweeps adds nothing, all rows agree with both of their neighbours.
  for (bool down = true; result.sweeps < bound; down = !down) {
    ++result.sweeps;
    const bool grew = down ? sweep(seeds, mask, 0, 1) : sweep(seeds, mask, mask.height - 1, -1);
    if (!grew && result.sweeps > 1) return result;
  }
  result.finished = false;
  return result;
}

}  // namespace touchline
