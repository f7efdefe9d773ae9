// SPDX-License-Identifier: Apache-2.0
// The rule of thinning on blocks of 64 columns and four rows, in the compilers' own vector notation. Included by each
// file of kernels alone, and compiled there for that file's processor: everything is local to the file. Neighbours are
// named by where they lie; the publication counts them p2 to p9, clockwise from north.
#pragma once

#include "vision/image/thinning_pass.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {
namespace thinning {

#if defined(__AVX2__)
inline constexpr int rows_at_once = 4;
#else
inline constexpr int rows_at_once = 2;
#endif
using RowVector = BitWord __attribute__((vector_size(8 * rows_at_once)));

template <typename Rows>
[[gnu::always_inline]] inline Rows load(const BitWord* from) {
  Rows rows;
  __builtin_memcpy(&rows, from, sizeof rows);
  return rows;
}

template <typename Rows>
struct Seen {
  Rows west, here, east;  // the pixel to the left, the pixel, the pixel to the right
};
template <typename Rows>
[[gnu::always_inline]] inline Seen<Rows> see(const BitWord* left, const BitWord* here, const BitWord* right) {
  const Rows h = load<Rows>(here);
  return {(h << 1) | (load<Rows>(left) >> 63), h, (h >> 1) | (load<Rows>(right) << 63)};
}

/// The pixels that a pass deletes. A(p1) is the number of 0 -> 1 steps around the pixel, B(p1) that of set neighbours.
template <typename Rows>
[[gnu::always_inline]] inline Rows rule(const Seen<Rows>& north, const Seen<Rows>& middle, const Seen<Rows>& south,
                                        bool second) {
  const Rows n = north.here, e = middle.east, s = south.here, w = middle.west;
  const Rows ne = north.east, se = south.east, sw = south.west, nw = north.west;
  // Steps from n over ne to e, and so on: of two adjacent steps at the most one goes up.
  const Rows a = e ^ (ne & ~(e ^ n));
  const Rows b = s ^ (se & ~(s ^ e));
  const Rows c = w ^ (sw & ~(w ^ s));
  const Rows d = n ^ (nw & ~(n ^ w));
  // A(p1) = 1: an odd number of four, and not three.
  const Rows one_step = (a ^ b ^ c ^ d) & ~(a & b) & ~(c & d);
  // 2 <= B(p1) <= 6: the set neighbours are now one run, and so are the others. A run of two or more has a straight
  // neighbour and a diagonal one. (That all straight ones are set is among what keeps a pixel below.)
  const Rows two_to_six = (n | e | s | w) & (ne | se | sw | nw) & ~(ne & se & sw & nw);
  // First pass: p2 p4 p6 = 0 and p4 p6 p8 = 0. Second: p2 p4 p8 = 0 and p2 p6 p8 = 0.
  const Rows kept = second ? n & w & (e | s) : e & s & (n | w);
  return middle.here & one_step & two_to_six & ~kept;
}

template <typename Rows>
[[gnu::always_inline]] inline Rows deleted_at(const BitWord* left, const BitWord* here, const BitWord* right,
                                              bool second) {
  return rule(see<Rows>(left - 1, here - 1, right - 1), see<Rows>(left, here, right),
              see<Rows>(left + 1, here + 1, right + 1), second);
}

/// Looks at a block; true when something goes.
[[gnu::always_inline]] inline bool look(const BitWord* left, const BitWord* here, const BitWord* right, bool second,
                                        BitWord* deleted) {
  BitWord any = 0;
  if constexpr (vector_registers) {
    RowVector some = {};
    for (int y = 0; y < thinning_block_rows; y += rows_at_once) {
      const RowVector gone = deleted_at<RowVector>(left + y, here + y, right + y, second);
      __builtin_memcpy(deleted + y, &gone, sizeof gone);
      some |= gone;
    }
    for (int k = 0; k < rows_at_once; ++k) any |= some[k];
  } else {
    for (int y = 0; y < thinning_block_rows; ++y) {
      deleted[y] = here[y] == 0 ? 0 : deleted_at<BitWord>(left + y, here + y, right + y, second);
      any |= deleted[y];
    }
  }
  return any != 0;
}

/// Calls visit(word of marks, bit, first row) for every marked block of a column. The last block reaches back over the
/// one before.
template <typename Visit>
[[gnu::always_inline]] inline void for_each_block(const BitWord* marks, int words, int height, Visit visit) {
  for (int i = 0; i < words; ++i) {
    for (BitWord left = marks[i]; left != 0; left &= left - 1) {
      const int bit = __builtin_ctzll(left);
      const int y = thinning_block_rows * (bits_per_word * i + bit);
      visit(i, bit, y < height - thinning_block_rows ? y : height - thinning_block_rows);
    }
  }
}

inline bool run(const ThinningPass& p) {
  const int stride = p.height + 2;
  BitWord any = 0;
  for (int i = 0; i < p.column_count; ++i) {
    const BitWord* here = p.columns + (i + 1) * stride + 1;
    const BitWord* left = here - stride;
    const BitWord* right = i + 1 < p.column_count ? here + stride : p.columns + 1;
    BitWord* changed = p.changed + i * p.marks;
    BitWord* deleted = p.deleted + i * p.height;
    for_each_block(p.active + i * p.marks, p.marks, p.height, [&](int word, int bit, int y) {
      const bool some = look(left + y, here + y, right + y, p.second, deleted + y);
      changed[word] |= BitWord{some} << bit;
    });
  }
  for (int i = 0; i < p.column_count; ++i) {
    BitWord* here = p.columns + (i + 1) * stride + 1;
    const BitWord* deleted = p.deleted + i * p.height;
    for_each_block(p.changed + i * p.marks, p.marks, p.height, [&](int, int, int y) {
      for (int k = 0; k < thinning_block_rows; ++k) here[y + k] &= ~deleted[y + k];
    });
    for (int k = 0; k < p.marks; ++k) any |= p.changed[i * p.marks + k];
  }
  return any != 0;
}

}  // namespace thinning
}  // namespace
}  // namespace touchline
