// SPDX-License-Identifier: Apache-2.0
// The parts of Canny that look at every pixel, on rows of 16-bit samples. Which rows and columns is the caller's
// (canny.cpp), and what they mean is told there. No sum exceeds the 15 bits of a positive lane: 22,440 is the largest
// magnitude.
#pragma once

#include <cstdint>

namespace touchline {

/// Columns first..end-1 of a row.
struct EdgeColumns {
  int first = 0;
  int end = 0;
};

/// What a row's gradient is made of and goes to; sums and steps have a sample on either side of the row.
struct EdgeSlopes {
  const std::uint16_t* sums = nullptr;
  const std::int16_t* steps = nullptr;
  std::int16_t* gx = nullptr;
  std::int16_t* gy = nullptr;
  std::uint16_t* magnitude = nullptr;
};

/// Gradients of a row, and magnitudes of it and its neighbours, with a sample on either side.
struct EdgeNeighbours {
  const std::int16_t* gx = nullptr;
  const std::int16_t* gy = nullptr;
  const std::uint16_t* above = nullptr;
  const std::uint16_t* here = nullptr;
  const std::uint16_t* below = nullptr;
  int width = 0;
};

struct EdgeMaxima {
  std::uint64_t weak = 0;
  std::uint64_t strong = 0;
};

/// Three rows of luma; at the image's border the outermost ones repeat.
struct EdgeLuma {
  const std::uint8_t* above = nullptr;
  const std::uint8_t* here = nullptr;
  const std::uint8_t* below = nullptr;
  int width = 0;
};

/// Of Sobel's gradient: whether the component along the row is at least as large as the other, and whether they lead
/// to the right and down, or are zero.
struct EdgeDirections {
  std::uint64_t along_row = 0;
  std::uint64_t right = 0;
  std::uint64_t below = 0;
};

/// Columns that are looked at together. Rows of 16-bit samples have room for whole blocks.
inline constexpr int edge_block_px = 32;

/// What the gradient of a row is made of, five rows each with its own in the middle, and what it goes to.
struct EdgeGradients {
  const std::int16_t* steps[5] = {};
  const std::int16_t* sums[5] = {};
  std::int16_t* gx = nullptr;
  std::int16_t* gy = nullptr;
  std::uint16_t* magnitude = nullptr;
  int width = 0;
};

struct EdgeKernels {
  /// Of the blocks of a row of luma: steps = (-1 -2 0 2 1), sums = (1 4 6 4 1) along the row. Beyond its ends its
  /// samples come again in reverse.
  void (*smooth)(const std::uint8_t* luma, int width, std::uint64_t blocks, std::int16_t* steps,
                 std::int16_t* sums) = nullptr;
  /// Gradients and magnitudes of a block: gx = (1 4 6 4 1) down the steps, gy = (-1 -2 0 2 1) down the sums. Bit i:
  /// column x0 + i has at least `threshold`; bits beyond the width mean nothing. The magnitude behind the last column
  /// is zero.
  std::uint32_t (*gradients)(const EdgeGradients& rows, int x0, int threshold) = nullptr;
  /// Of the candidates, bit i for column x0 + i, those whose magnitude is the largest along their gradient; strong:
  /// and at least `threshold`.
  EdgeMaxima (*maxima)(const EdgeNeighbours& rows, int x0, std::uint64_t candidates, int threshold) = nullptr;
  /// Of the `wanted` pixels, bit i for column x0 + i; the other bits mean nothing.
  EdgeDirections (*directions)(const EdgeLuma& luma, int x0, std::uint64_t wanted) = nullptr;
};

}  // namespace touchline
