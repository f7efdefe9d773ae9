// SPDX-License-Identifier: Apache-2.0
// Two rows of a frame of the working size (RowPair, same_size.h), in blocks that a compiler makes vectors of. Included
// by each file of kernels alone, and compiled there for that file's processor: everything is local to the file.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/same_size.h"

namespace touchline {
namespace {
namespace change_rows {

[[gnu::always_inline]] inline std::uint8_t sample(const ColourRow& m, int c0, int c1, int c2, int offset, int shift) {
  const std::int32_t value = (m.a * c0 + m.b * c1 + m.c * c2 + offset) >> shift;
  return static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
}

/// Columns x to x + Count: the channels apart first, then plane by plane.
template <std::size_t Count>
[[gnu::always_inline]] inline void change(const RowPair& rows, const ColourMatrix& m, int x) {
  constexpr int count = Count;
  constexpr int round_luma = 1 << (colour_bits - 1);
  std::int16_t channel[2][3][Count];
  for (int r = 0; r < 2; ++r) {
    const std::uint8_t* from = rows.source[r] + std::ptrdiff_t{3} * x;
    for (int i = 0; i < count; ++i) {
      for (int c = 0; c < 3; ++c) channel[r][c][i] = from[3 * i + c];
    }
    std::uint8_t* to = rows.y[r] + x;
    const auto& p = channel[r];
    for (int i = 0; i < count; ++i)
      to[i] = sample(m.y, p[0][i], p[1][i], p[2][i], m.y.offset + round_luma, colour_bits);
  }
  // Chroma of four pixels at once: their sum, divided with the coefficients' scale.
  constexpr int shift = colour_bits + 2;
  std::int16_t sum[3][Count / 2];
  for (int c = 0; c < 3; ++c) {
    const std::int16_t* upper = channel[0][c];
    const std::int16_t* lower = channel[1][c];
    for (int i = 0; i < count / 2; ++i) {
      sum[c][i] = static_cast<std::int16_t>(upper[2 * i] + upper[2 * i + 1] + lower[2 * i] + lower[2 * i + 1]);
    }
  }
  const auto plane = [&](const ColourRow& row, std::uint8_t* to) __attribute__((always_inline)) {
    const std::int32_t offset = 4 * row.offset + (1 << (shift - 1));
    for (int i = 0; i < count / 2; ++i) to[i] = sample(row, sum[0][i], sum[1][i], sum[2][i], offset, shift);
  };
  plane(m.cb, rows.cb + x / 2);
  plane(m.cr, rows.cr + x / 2);
}

inline void run(const RowPair& rows) {
  constexpr int block_px = 32;
  const ColourMatrix matrix = rows.matrix;
  int x = 0;
  for (; x + block_px <= rows.columns; x += block_px) change<block_px>(rows, matrix, x);
  for (; x < rows.columns; x += 2) change<2>(rows, matrix, x);
}

}  // namespace change_rows
}  // namespace
}  // namespace touchline
