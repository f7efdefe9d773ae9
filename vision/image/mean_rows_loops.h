// SPDX-License-Identifier: Apache-2.0
// The mean of four rows in bytes alone, by means of two, which vector registers have an instruction for; it may be
// written over one of the rows. Included by files of kernels alone, and compiled there for that file's processor.
#pragma once

#include <cstdint>

namespace touchline {
namespace {
namespace mean_rows {

/// The mean of both means is one too large where it was rounded up and one of them was, too.
[[gnu::always_inline]] inline std::uint8_t mean(int a, int b, int c, int d) {
  const int ab = (a + b + 1) >> 1;
  const int cd = (c + d + 1) >> 1;
  const int too_large = ((a ^ b) | (c ^ d)) & (ab ^ cd) & 1;
  return static_cast<std::uint8_t>(((ab + cd + 1) >> 1) - too_large);
}

inline void mean_of_four(const std::uint8_t* const* rows, int width, std::uint8_t* out) {
  constexpr int part_px = 64;  // a part is read whole before it is written
  const std::uint8_t* const a = rows[0];
  const std::uint8_t* const b = rows[1];
  const std::uint8_t* const c = rows[2];
  const std::uint8_t* const d = rows[3];
  int x = 0;
  for (; x + part_px <= width; x += part_px) {
    std::uint8_t part[part_px];
    for (int i = 0; i < part_px; ++i) part[i] = mean(a[x + i], b[x + i], c[x + i], d[x + i]);
    __builtin_memcpy(out + x, part, part_px);
  }
  for (; x < width; ++x) out[x] = mean(a[x], b[x], c[x], d[x]);
}

}  // namespace mean_rows
}  // namespace
}  // namespace touchline
