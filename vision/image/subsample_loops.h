// SPDX-License-Identifier: Apache-2.0
// The loops of subsampling for any ratio (SubsampleKernels, kernels.h), plain ones that compilers make vectors of.
// Included by each file of kernels alone, and compiled there for that file's processor: everything is local to the
// file.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/kernels.h"

namespace touchline {
namespace {
namespace subsample_loops {

/// sums (+)= weight * row.
inline void add_row(const std::uint8_t* row, int count, int weight, bool first, std::uint16_t* sums) {
  const auto w = static_cast<std::uint16_t>(weight);
  if (first) {
    for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(row[i] * w);
  } else {
    for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + row[i] * w);
  }
}

/// Column by column.
inline void reduce_columns(const ColumnSums& given) {
  const ColumnSums s = given;
  const std::uint16_t* weight = s.weights;
  for (int x = 0; x < s.columns; ++x, weight += s.taps) {
    const std::uint16_t* source = s.sums + 3 * s.first_column[x];
    std::uint32_t total[3] = {};
    for (int t = 0; t < s.taps; ++t) {
      for (int c = 0; c < 3; ++c) total[c] += std::uint32_t{source[3 * t + c]} * weight[t];
    }
    for (int c = 0; c < 3; ++c) s.out[4 * x + c] = static_cast<std::uint16_t>(total[c] >> s.shift);
  }
}

/// One plane of the result. 8.6 bit times 14 bit stays below 2^31.
inline void change_colour(const ChannelRow& given, const ColourRow& m, std::uint8_t* out) {
  const ChannelRow row = given;
  constexpr int shift = colour_bits + subsample_fraction_bits;
  const std::int32_t offset = m.offset * (1 << subsample_fraction_bits) + (1 << (shift - 1));
  const std::int16_t a = m.a, b = m.b, c = m.c;
  for (int x = 0; x < row.columns; ++x) {
    const std::int32_t sum = a * static_cast<std::int16_t>(row.channel[0][x]) +
                             b * static_cast<std::int16_t>(row.channel[1][x]) +
                             c * static_cast<std::int16_t>(row.channel[2][x]) + offset;
    const std::int32_t value = sum >> shift;
    out[x] = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
  }
}

/// Means of 2x2; at an odd border the last column counts twice.
inline void halve(const std::uint16_t* upper, const std::uint16_t* lower, int columns, std::uint16_t* out) {
  for (int x = 0; x < columns / 2; ++x) {
    out[x] = static_cast<std::uint16_t>((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) >> 2);
  }
  if (columns % 2 != 0) {
    out[columns / 2] = static_cast<std::uint16_t>((upper[columns - 1] + lower[columns - 1] + 1) >> 1);
  }
}

constexpr SubsampleKernels kernels(ReduceColumns reduce = reduce_columns) {
  return {add_row, reduce, change_colour, halve};
}

}  // namespace subsample_loops
}  // namespace
}  // namespace touchline
