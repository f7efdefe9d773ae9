// SPDX-License-Identifier: Apache-2.0
// Sines of poses, and noise, in lanes. Included by files of kernels alone, as lanes_loops.h is.
#pragma once

#include "loc/kernels.h"
#include "platform/core/angle_loops.h"
#include "platform/core/lanes_loops.h"

namespace touchline {
namespace {

template <class L>
void sin_cos(const float* angles, float* sin, float* cos) {
  for (int lane = 0; lane < pose_lanes; lane += L::lanes) {
    const SineCosine<L> both = sine_cosine_of<L>(load<L>(angles + lane));
    store(sin + lane, both.sin);
    store(cos + lane, both.cos);
  }
}

/// Box and Muller, "A note on the generation of random normal deviates" (1958): a radius and an angle make two. Each
/// takes 24 bits of a word, so that none is beyond 5.9.
template <class L>
void normals(const std::uint32_t* words, Noise& noise) {
  using F = typename L::F;
  using I = typename L::I;
  constexpr int half = noise_block / 2;
  for (int row = 0; row < 3; ++row) {
    for (int lane = 0; lane < half; lane += L::lanes) {
      I first, second;
      __builtin_memcpy(&first, words + row * noise_block + lane, sizeof first);
      __builtin_memcpy(&second, words + row * noise_block + half + lane, sizeof second);
      const F uniform = (as_float((first >> 8) & 0x00FFFFFF) + 0.5F) * 0x1.0p-24F;  // in (0, 1]
      const F radius = root(-2.0F * logarithm<L>(uniform));
      // The upper two bits are quarter turns, 22 bits where in the quarter.
      const F rest = (as_float((second >> 8) & 0x003FFFFF) - 2097151.5F) * (1.57079632679F / 4194304.0F);
      const SineCosine<L> both = sine_cosine<L>((second >> 30) & 3, rest);
      store(noise.value[row] + lane, radius * both.sin);
      store(noise.value[row] + half + lane, radius * both.cos);
    }
  }
}

}  // namespace
}  // namespace touchline
