// SPDX-License-Identifier: Apache-2.0
// The rows of Canny for processors without vector registers: two samples of 16 bits in each word of 32 (H. S. Warren,
// "Hacker's Delight", 2nd ed., sections 2-18 and 7-2). Signed samples carry a bias that keeps them positive, so that
// nothing is borrowed from the neighbour.
#pragma once

#include <cstdint>
#include <cstring>

#include "vision/image/edge_rows.h"
#include "vision/image/word_lanes.h"

namespace touchline::canny_words {

inline constexpr int block_px = 32;           // flags that fill a register
inline constexpr int step_bias = 0x1000;      // of differences of two blurred samples, which are at most 4080
inline constexpr int slope_bias = half_bias;  // of a gradient's components, at most 16320
inline constexpr std::uint32_t ones = 0x00010001U;
inline constexpr std::uint32_t tops = 0x80008000U;

inline std::uint32_t load(const void* from) {
  std::uint32_t word = 0;
  std::memcpy(&word, from, sizeof word);
  return word;
}
inline void store(void* to, std::uint32_t word) { std::memcpy(to, &word, sizeof word); }

/// out = above + 2 here + below, of bytes.
inline void sum_rows(const std::uint8_t* above, const std::uint8_t* here, const std::uint8_t* below,
                     EdgeColumns columns, std::uint16_t* out) {
  const int end = columns.end;
  int x = columns.first;
  for (; x + 4 <= end; x += 4) {
    const std::uint32_t a = load(above + x), h = load(here + x), b = load(below + x);
    const std::uint32_t even = add_even_bytes(add_even_bytes(even_bytes(a), b) + even_bytes(h), h);
    const std::uint32_t odd = add_odd_bytes(add_odd_bytes(odd_bytes(a), b) + odd_bytes(h), h);
    store(out + x, lower_halves(even, odd));
    store(out + x + 2, upper_halves(even, odd));
  }
  for (; x < end; ++x) out[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
}

/// out = left + 2 here + right. Samples up to 1020.
inline void sum_columns(const std::uint16_t* in, EdgeColumns columns, std::uint16_t* out) {
  const int end = columns.end;
  int x = columns.first;
  for (; x + 2 <= end; x += 2) store(out + x, load(in + x - 1) + 2 * load(in + x) + load(in + x + 1));
  for (; x < end; ++x) out[x] = static_cast<std::uint16_t>(in[x - 1] + 2 * in[x] + in[x + 1]);
}

/// sums = above + 2 here + below, steps = below - above + step_bias, of blurred rows.
inline void sum_and_step(const std::uint16_t* above, const std::uint16_t* here, const std::uint16_t* below,
                         EdgeColumns columns, std::uint16_t* sums, std::int16_t* steps) {
  const int end = columns.end;
  int x = columns.first;
  for (; x + 2 <= end; x += 2) {
    const std::uint32_t a = load(above + x), b = load(below + x);
    store(sums + x, a + 2 * load(here + x) + b);
    store(steps + x, b + step_bias * ones - a);
  }
  for (; x < end; ++x) {
    sums[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
    steps[x] = static_cast<std::int16_t>(below[x] - above[x] + step_bias);
  }
}

/// Even bits from the lower half, odd ones from the upper half.
inline std::uint32_t interleaved(std::uint32_t halves) {
  std::uint32_t v = halves;
  const auto swap = [&v](std::uint32_t mask, unsigned by) {
    const std::uint32_t t = (v ^ v >> by) & mask;
    v ^= t ^ t << by;
  };
  swap(0x0000FF00U, 8);
  swap(0x00F000F0U, 4);
  swap(0x0C0C0C0CU, 2);
  swap(0x22222222U, 1);
  return v;
}

/// One pixel; whether its magnitude is at least `threshold`.
inline bool slope_at(const EdgeSlopes& s, int x, int threshold) {
  const int gx = s.sums[x + 1] - s.sums[x - 1];
  const int gy = s.steps[x - 1] + 2 * s.steps[x] + s.steps[x + 1] - slope_bias;
  const int ax = gx < 0 ? -gx : gx;
  const int ay = gy < 0 ? -gy : gy;
  const int least = ax < ay ? ax : ay;
  const int magnitude = ax + ay - least + least * 3 / 8;
  s.gx[x] = static_cast<std::int16_t>(gx + slope_bias);
  s.gy[x] = static_cast<std::int16_t>(gy + slope_bias);
  s.magnitude[x] = static_cast<std::uint16_t>(magnitude);
  return magnitude >= threshold;
}

/// The same for 32 pixels, a bit each.
inline std::uint32_t slopes_of_block(const EdgeSlopes& s, int x0, int threshold) {
  const std::uint32_t up_to_top = tops - static_cast<std::uint32_t>(threshold) * ones;
  std::uint32_t flags = 0;
  for (int x = x0; x < x0 + block_px; x += 2) {
    const std::uint32_t gx = load(s.sums + x + 1) + slope_bias * ones - load(s.sums + x - 1);
    const std::uint32_t gy = load(s.steps + x - 1) + 2 * load(s.steps + x) + load(s.steps + x + 1);
    const std::uint32_t ax = without_bias_and_sign(gx);
    const std::uint32_t ay = without_bias_and_sign(gy);
    const std::uint32_t least = smaller_halves(ax, ay);
    const std::uint32_t magnitude = ax + ay - least + (3 * least >> 3U & 0x1FFF1FFFU);
    store(s.gx + x, gx);
    store(s.gy + x, gy);
    store(s.magnitude + x, magnitude);
    flags = flags >> 1U | ((magnitude + up_to_top) & tops);
  }
  return interleaved(flags);
}

}  // namespace touchline::canny_words
