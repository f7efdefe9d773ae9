// SPDX-License-Identifier: Apache-2.0
// The eight neighbours of 64 pixels at once, one word a direction: for rules that look at a pixel's neighbourhood.
#pragma once

#include "vision/image/bit_image.h"

namespace touchline {

/// Bit k of each word: that neighbour of pixel k. Clockwise from north.
struct NeighbourWords {
  BitWord n, ne, e, se, s, sw, w, nw;
};

/// A row as seen from its word i: the pixels to the left, the pixels, the pixels to the right.
struct RowTriple {
  BitWord west, here, east;
};
inline RowTriple row_triple(const BitWord* row, int i, int words) {
  if (row == nullptr) return {0, 0, 0};
  const BitWord before = i > 0 ? row[i - 1] : 0;
  const BitWord after = i + 1 < words ? row[i + 1] : 0;
  return {(row[i] << 1) | (before >> (bits_per_word - 1)), row[i], (row[i] >> 1) | (after << (bits_per_word - 1))};
}

/// Of word i of a row of `words`; `above` and `below` are null outside the image.
inline NeighbourWords neighbour_words(const BitWord* above, const BitWord* here, const BitWord* below, int i,
                                      int words) {
  const RowTriple north = row_triple(above, i, words);
  const RowTriple middle = row_triple(here, i, words);
  const RowTriple south = row_triple(below, i, words);
  return {north.here, north.east, middle.east, south.east, south.here, south.west, middle.west, north.west};
}

/// How many neighbours are set, in bits of their own.
struct NeighbourCount {
  BitWord odd, two, four;  // an odd number; two or more; four or more
};
inline NeighbourCount count_neighbours(const NeighbourWords& n) {
  const auto add = [](BitWord a, BitWord b, BitWord c, BitWord& carry) {
    const BitWord ab = a ^ b;
    carry = (a & b) | (ab & c);
    return ab ^ c;
  };
  BitWord carry[4];
  const BitWord a = add(n.n, n.ne, n.e, carry[0]);
  const BitWord b = add(n.se, n.s, n.sw, carry[1]);
  const BitWord c = add(n.w, n.nw, 0, carry[2]);
  const BitWord odd = add(a, b, c, carry[3]);
  const BitWord ab = carry[0] | carry[1];
  const BitWord cd = carry[2] | carry[3];
  return {odd, ab | cd, (carry[0] & carry[1]) | (carry[2] & carry[3]) | (ab & cd)};
}

}  // namespace touchline
