// SPDX-License-Identifier: Apache-2.0
// Zhang-Suen thinning, 64 pixels a word (Zhang and Suen, "A Fast Parallel Algorithm for Thinning Digital Patterns",
// CACM 27(3), 1984; paper section IV-C). The result is that of the textbook, pixel by pixel, with its known losses:
// a 2x2 block vanishes, and so does nearly all of a diagonal two pixels wide. Lines three pixels wide and more stay
// connected.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/thinning_pass.h"

namespace touchline {

/// Working memory for a mask; its contents do not matter.
struct ThinningMemory {
  std::span<BitWord> columns;  // thinning_columns_size(width, height)
  std::span<BitWord> deleted;  // thinning_deleted_size(width, height)
  std::span<BitWord> marks;    // thinning_marks_size(width, height)
};
/// Rows that are worked on: a block's at least.
constexpr int thinning_height(int height) { return std::max(height, thinning_block_rows); }
constexpr std::size_t thinning_columns_size(int width, int height) {
  return static_cast<std::size_t>((words_for(width) + 1) * thinning_stride(thinning_height(height)));
}
constexpr std::size_t thinning_deleted_size(int width, int height) {
  return static_cast<std::size_t>(words_for(width) * thinning_height(height));
}
/// Words of marks for the blocks of a column.
constexpr int thinning_marks(int height) { return words_for((height + thinning_block_rows - 1) / thinning_block_rows); }
constexpr std::size_t thinning_marks_size(int width, int height) {
  return static_cast<std::size_t>(4 * words_for(width) * thinning_marks(height));
}

/// Storage of all but `deleted`, for which any mask of that size will do.
template <int W, int H>
struct ThinningStorage {
  std::array<BitWord, thinning_columns_size(W, H)> columns{};
  std::array<BitWord, thinning_marks_size(W, H)> marks{};
};

/// Passes (two an iteration) that thin() makes at most: a blob loses a layer an iteration, so half the shorter side is
/// usual. Diagonals of width two are eaten from their ends, a pixel an iteration, which is what the longer bound is
/// for.
constexpr int max_thinning_iterations(int width, int height) { return width + height; }

struct ThinningResult {
  int iterations = 0;    // the last one changed nothing
  bool finished = true;  // false: the bound was reached and some lines are thicker than a pixel
};

/// For every processor.
[[nodiscard]] ThinningKernel portable_thinning();

/// Thins `mask` in place; outside the image counts as zero and border pixels are thinned like all others. Only blocks
/// near a change of the last two passes are looked at again, so the cost follows the lines and not the area.
ThinningResult thin(BitView mask, const ThinningMemory& memory, ThinningKernel kernel = nullptr);

}  // namespace touchline
