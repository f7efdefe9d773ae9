// SPDX-License-Identifier: Apache-2.0
// One pass of thinning over a copy of the mask that is laid out column by column: word i of all rows, one below the
// other, so that some rows of 64 pixels are one vector wherever they begin.
#pragma once

#include "vision/image/bit_image.h"

namespace touchline {

/// Rows of a block: what is looked at at once, and what a mark stands for.
inline constexpr int thinning_block_rows = 4;

/// The copy has a row of zeros above and below every column, and a column of zeros first of all.
struct ThinningPass {
  BitWord* columns = nullptr;       // of the column of zeros
  BitWord* deleted = nullptr;       // room for `height` words a column
  const BitWord* active = nullptr;  // a bit a block: look at it
  BitWord* changed = nullptr;       // all zero; a bit is set where something was deleted
  int column_count = 0;
  int height = 0;  // a block's at least
  int marks = 0;   // words of marks a column
  bool second = false;
};

constexpr int thinning_stride(int height) { return height + 2; }

/// True when a pixel was deleted.
using ThinningKernel = bool (*)(const ThinningPass& pass);

}  // namespace touchline
