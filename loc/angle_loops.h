// SPDX-License-Identifier: Apache-2.0
// Sine, cosine and normal numbers in lanes: the polynomials of platform/core/elementary.cpp, in the same order, so that
// a sine is the same float whoever asks for it. Included by files of kernels alone, as lanes_loops.h is.
#pragma once

#include "loc/kernels.h"
#include "loc/lanes_loops.h"

namespace touchline {
namespace {

template <class L>
struct SineCosine {
  typename L::F sin, cos;
};

/// Of `quarters` turns by 90 degrees and `rest` radians, which are within 45 degrees.
template <class L>
[[gnu::always_inline]] inline SineCosine<L> sine_cosine(typename L::I quarters, typename L::F rest) {
  using F = typename L::F;
  const F z = rest * rest;
  const F s = rest + rest * z * (-0.166666549437F + z * (8.332178147e-3F + z * -1.9517299e-4F));
  const F tail = z * z * (4.166664686642e-2F + z * (-1.388736751474e-3F + z * 2.443845149276e-5F));
  const F c = 1.0F - (0.5F * z - tail);
  const auto odd = (quarters & 1) != 0;
  const F sin = choose(odd, c, s);
  const F cos = choose(odd, s, c);
  return {choose((quarters & 2) != 0, -sin, sin), choose(((quarters + 1) & 2) != 0, -cos, cos)};
}

template <class L>
void sin_cos(const float* angles, float* sin, float* cos) {
  using F = typename L::F;
  for (int lane = 0; lane < pose_lanes; lane += L::lanes) {
    const F radians = load<L>(angles + lane);
    const F turns = radians * 0.636619772367581F;
    const auto quarters = truncated(turns + with_sign(all<L>(0.5F), turns));
    const F n = as_float(quarters);
    const F rest = ((radians - n * 1.5703125F) - n * 4.837512969970703e-4F) - n * 7.549789954891882e-8F;
    const SineCosine<L> both = sine_cosine<L>(quarters, rest);
    store(sin + lane, both.sin);
    store(cos + lane, both.cos);
  }
}

/// Natural logarithm of normal positive numbers.
template <class L>
[[gnu::always_inline]] inline typename L::F logarithm(typename L::F x) {
  using F = typename L::F;
  const auto bits = bits_of(x);
  const F one_to_two = from_bits((bits & 0x007FFFFF) | 0x3F800000);
  const auto large = one_to_two > 1.41421356F;
  const F mantissa = choose(large, 0.5F * one_to_two, one_to_two);
  const F n = as_float((bits >> 23) - 127) + choose(large, all<L>(1.0F), all<L>(0.0F));
  const F s = (mantissa - 1.0F) / (mantissa + 1.0F);
  const F z = s * s;
  const F p = s * z * (0.666667763815F + z * (0.399775415883F + z * 0.298717274544F));
  return n * 0.693145751953125F + (2.0F * s + (p + n * 1.4286068203094173e-6F));
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
