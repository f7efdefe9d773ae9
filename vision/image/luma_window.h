// SPDX-License-Identifier: Apache-2.0
// Sixty-four lumas against the window that the chroma of each pair leaves them: once for processors with vector
// registers, once four bytes at a time in a register, for those without. Both give the same bits.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "vision/image/bit_pack.h"

namespace touchline {

#if defined(__SSE2__) || defined(__ARM_NEON)
inline constexpr bool vector_registers = true;  // plain loops over bytes vectorise
#else
inline constexpr bool vector_registers = false;
#endif

/// Bit i: low[i / 2] <= y[i] <= high[i / 2], for i < used <= 64.
inline BitWord luma_window_by_vectors(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high,
                                      int used) {
  // Whole words of fixed length: 32 chroma samples, each twice, and 64 lumas.
  std::array<std::uint8_t, bits_per_word> from{};
  std::array<std::uint8_t, bits_per_word> to{};
  std::array<std::uint8_t, bits_per_word> flags{};
  const int samples = (used + 1) / 2;
  for (int i = 0; i < samples; ++i) {
    const auto x = static_cast<std::size_t>(2 * i);
    from[x] = from[x + 1] = low[i];
    to[x] = to[x + 1] = high[i];
  }
  for (int i = 0; i < used; ++i) {
    const auto x = static_cast<std::size_t>(i);
    flags[x] = static_cast<std::uint8_t>((y[i] >= from[x] ? 1 : 0) & (y[i] <= to[x] ? 1 : 0));
  }
  return pack_flags(flags.data());
}

/// The same, four at a time (H. S. Warren, "Hacker's Delight", 2nd ed., section 2-18: arithmetic on parts of words).
inline BitWord luma_window_by_words(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high,
                                    int used) {
  constexpr std::uint32_t tops = 0x80808080U;
  // The top bit of each byte: a >= b, unsigned.
  const auto at_least = [](std::uint32_t a, std::uint32_t b) {
    return (a & ~b) | (~(a ^ b) & ((a | tops) - (b & ~tops)));
  };
  const auto twice = [](const std::uint8_t* two) {
    std::uint16_t both = 0;
    std::memcpy(&both, two, sizeof both);
    return ((both | std::uint32_t{both} << 8U) & 0x00FF00FFU) * 0x0101U;
  };
  std::uint32_t halves[2] = {};
  int i = 0;
  for (; i + 4 <= used; i += 4) {
    std::uint32_t four = 0;
    std::memcpy(&four, y + i, sizeof four);
    const std::uint32_t inside = at_least(four, twice(low + i / 2)) & at_least(twice(high + i / 2), four) & tops;
    // Byte k's flag, at bit 8 k, to bit 24 + k; no two products meet there.
    halves[i / 32] |= ((inside >> 7U) * 0x01020408U >> 24U & 15U) << (i % 32);
  }
  BitWord word = halves[0] | BitWord{halves[1]} << 32U;
  for (; i < used; ++i) {
    if (y[i] >= low[i / 2] && y[i] <= high[i / 2]) word |= BitWord{1} << i;
  }
  return word;
}

inline BitWord luma_window(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high, int used) {
  return vector_registers ? luma_window_by_vectors(y, low, high, used) : luma_window_by_words(y, low, high, used);
}

}  // namespace touchline
