// SPDX-License-Identifier: Apache-2.0
// Eight 16-bit lanes in the compilers' own vector notation (g++ and clang, every processor: where there are no vector
// registers they make scalar code of it). For the few loops that do not vectorise by themselves.
#pragma once

#include <cstdint>
#include <cstring>

namespace touchline {

using U16x8 = std::uint16_t __attribute__((vector_size(16)));

inline U16x8 load_lanes(const std::uint16_t* from) {
  U16x8 v;
  std::memcpy(&v, from, sizeof v);
  return v;
}
/// Four samples from either address.
inline U16x8 load_halves(const std::uint16_t* low, const std::uint16_t* high) {
  using U64x2 = std::uint64_t __attribute__((vector_size(16)));
  std::uint64_t a = 0;
  std::uint64_t b = 0;
  std::memcpy(&a, low, sizeof a);
  std::memcpy(&b, high, sizeof b);
  const U64x2 both = {a, b};
  U16x8 v;
  std::memcpy(&v, &both, sizeof v);
  return v;
}
inline void store_lanes(U16x8 v, std::uint16_t* to) { std::memcpy(to, &v, sizeof v); }

/// a0 b0 a1 b1 a2 b2 a3 b3, and the same of the upper halves.
inline U16x8 interleave_low(U16x8 a, U16x8 b) { return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11); }
inline U16x8 interleave_high(U16x8 a, U16x8 b) { return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15); }

}  // namespace touchline
