// SPDX-License-Identifier: Apache-2.0
// The mean of four rows in bytes alone, by means of two, which vector registers have an instruction for. Included by
// files of kernels alone, and compiled there for that file's processor.
#pragma once

#include <cstdint>

namespace touchline {
namespace {
namespace mean_rows {

/// (a + b + 1) / 2.
[[gnu::always_inline]] inline std::uint8_t rounded_up(std::uint8_t a, std::uint8_t b) {
  return static_cast<std::uint8_t>((a + b + 1) >> 1);
}

/// The mean of both means is one too large where it was rounded up and one of them was, too.
inline void mean_of_four(const std::uint8_t* const* rows, int width, std::uint8_t* out) {
  const std::uint8_t* const a = rows[0];
  const std::uint8_t* const b = rows[1];
  const std::uint8_t* const c = rows[2];
  const std::uint8_t* const d = rows[3];
  for (int x = 0; x < width; ++x) {
    const std::uint8_t ab = rounded_up(a[x], b[x]);
    const std::uint8_t cd = rounded_up(c[x], d[x]);
    const int too_large = ((a[x] ^ b[x]) | (c[x] ^ d[x])) & (ab ^ cd) & 1;
    out[x] = static_cast<std::uint8_t>(rounded_up(ab, cd) - too_large);
  }
}

}  // namespace mean_rows
}  // namespace
}  // namespace touchline
