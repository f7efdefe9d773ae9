// SPDX-License-Identifier: Apache-2.0
// PCG32 (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for Random Number
// Generation", XSH-RR variant). Always seeded by the caller; the same seed gives the same numbers on every board.
#pragma once

#include <cstdint>

namespace touchline {

class Rng {
 public:
  explicit Rng(std::uint64_t seed, std::uint64_t stream = 0);

  std::uint32_t next_u32();
  /// The next `count` of them.
  void next_u32s(std::uint32_t* to, int count);
  /// In [0, 1), 24 bits.
  float uniform();
  /// In [low, high).
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  /// In [0, bound), without bias; bound > 0. Bounded time: falls back to a biased draw after 16 rejections.
  std::uint32_t below(std::uint32_t bound);
  /// Mean 0, standard deviation 1 (polar method of Marsaglia, with at most 32 tries).
  float gaussian();

 private:
  std::uint64_t state_;
  std::uint64_t increment_;
  float spare_ = 0.0F;
  bool has_spare_ = false;
};

}  // namespace touchline
