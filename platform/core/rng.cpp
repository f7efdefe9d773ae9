// SPDX-License-Identifier: Apache-2.0
#include "platform/core/rng.h"

#include "platform/core/elementary.h"

namespace touchline {

Rng::Rng(std::uint64_t seed, std::uint64_t stream) : state_(0), increment_((stream << 1U) | 1U) {
  (void)next_u32();
  state_ += seed;
  (void)next_u32();
}

std::uint32_t Rng::next_u32() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto xor_shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
  const auto rotation = static_cast<std::uint32_t>(old >> 59U);
  return (xor_shifted >> rotation) | (xor_shifted << ((32U - rotation) & 31U));
}

void Rng::next_u32s(std::uint32_t* to, int count) {
  Rng here = *this;  // in registers: nothing that is stored can change it
  for (int i = 0; i < count; ++i) to[i] = here.next_u32();
  *this = here;
}

float Rng::uniform() { return static_cast<float>(next_u32() >> 8U) * 0x1.0p-24F; }

std::uint32_t Rng::below(std::uint32_t bound) {
  // The lowest 2^32 mod bound values would be drawn once too often: they are rejected.
  const std::uint32_t threshold = (0U - bound) % bound;
  std::uint32_t draw = next_u32();
  for (int rejected = 0; draw < threshold && rejected < 16; ++rejected) draw = next_u32();
  return draw % bound;
}

float Rng::gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  // A point of the square lies inside the circle with 79 %: all of 32 tries fail once in 10^21.
  for (int i = 0; i < 32; ++i) {
    const float x = uniform(-1.0F, 1.0F);
    const float y = uniform(-1.0F, 1.0F);
    const float s = x * x + y * y;
    if (s >= 1.0F || s < 1.0e-12F) continue;
    const float scale = math::sqrt(-2.0F * math::log(s) / s);
    spare_ = y * scale;
    has_spare_ = true;
    return x * scale;
  }
  return 0.0F;
}

}  // namespace touchline
