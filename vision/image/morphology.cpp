// SPDX-License-Identifier: Apache-2.0
// Erosion and dilation. A square of side 2 r + 1 is r squares of side 3, one after the other, also at the image's
// border, because the shortest way between two pixels never leaves the image. So one 3x3 pass in place, with three
// rolling rows, is all it takes.
#include "vision/image/morphology.h"

#include <algorithm>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

constexpr int max_row_words = words_for(max_mask_width);

/// `nothing`: what joins to an empty row when these of three are empty.
struct Dilation {
  static bool nothing(bool above, bool here, bool below) { return above && here && below; }
  static constexpr BitWord outside = 0;
  static BitWord join(BitWord a, BitWord b) { return a | b; }
};
struct Erosion {
  static bool nothing(bool above, bool here, bool below) { return above || here || below; }
  static constexpr BitWord outside = ~BitWord{0};
  static BitWord join(BitWord a, BitWord b) { return a & b; }
};

/// Joins every pixel of a row with its left and right neighbours. True when the row is empty, as `out` is then.
template <typename Operation>
bool join_along_row(const BitWord* row, int words, BitWord inside_last, BitWord* out) {
  BitWord any = 0;
  for (int i = 0; i < words; ++i) any |= row[i];
  if (any == 0) {
    for (int i = 0; i < words; ++i) out[i] = 0;
    return true;
  }
  const BitWord outside_last = Operation::outside & ~inside_last;
  BitWord left = Operation::outside;
  BitWord here = row[0] | (words == 1 ? outside_last : 0);
  for (int i = 0; i < words; ++i) {
    BitWord right = Operation::outside;
    if (i + 1 < words) right = row[i + 1] | (i + 2 == words ? outside_last : 0);
    const BitWord from_left = (here << 1) | (left >> (bits_per_word - 1));
    const BitWord from_right = (here >> 1) | (right << (bits_per_word - 1));
    out[i] = Operation::join(Operation::join(from_left, from_right), here);
    left = here;
    here = right;
  }
  return false;
}

template <typename Operation>
void pass_3x3(BitView mask) {
  const int words = words_for(mask.width);
  const BitWord inside_last = last_word_mask(mask.width);
  std::array<std::array<BitWord, max_row_words>, 3> rows;
  BitWord* above = rows[0].data();
  BitWord* here = rows[1].data();
  BitWord* below = rows[2].data();
  for (int i = 0; i < words; ++i) above[i] = Operation::outside;
  bool above_empty = Operation::outside == 0;
  bool here_empty = join_along_row<Operation>(mask.row(0), words, inside_last, here);
  for (int y = 0; y < mask.height; ++y) {
    bool below_empty = Operation::outside == 0;
    if (y + 1 < mask.height) {
      below_empty = join_along_row<Operation>(mask.row(y + 1), words, inside_last, below);
    } else {
      for (int i = 0; i < words; ++i) below[i] = Operation::outside;
    }
    BitWord* out = mask.row(y);
    if (Operation::nothing(above_empty, here_empty, below_empty)) {
      if (!here_empty) std::fill_n(out, words, BitWord{0});
    } else {
      for (int i = 0; i < words; ++i) out[i] = Operation::join(Operation::join(above[i], here[i]), below[i]);
      out[words - 1] &= inside_last;
    }
    above_empty = here_empty;
    here_empty = below_empty;
    BitWord* oldest = above;
    above = here;
    here = below;
    below = oldest;
  }
}

template <typename Operation>
void passes(BitView mask, int kernel_side, JoinSquares kernel) {
  assert(mask.width <= max_mask_width);
  if (mask.width <= 0 || mask.height <= 0 || kernel_side < 2) return;
  if (kernel != nullptr && kernel(mask, Operation::outside == 0, kernel_side / 2)) return;
  for (int i = 0; i < kernel_side / 2; ++i) pass_3x3<Operation>(mask);
}

}  // namespace

void dilate(BitView mask, int kernel_side, JoinSquares kernel) { passes<Dilation>(mask, kernel_side, kernel); }
void erode(BitView mask, int kernel_side, JoinSquares kernel) { passes<Erosion>(mask, kernel_side, kernel); }

}  // namespace touchline
