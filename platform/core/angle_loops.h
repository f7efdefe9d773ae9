// SPDX-License-Identifier: Apache-2.0
// Sine, cosine and logarithm in lanes: the polynomials of platform/core/elementary.cpp, in the same order, so that
// a sine is the same float whoever asks for it. Included by files of kernels alone, as lanes_loops.h is.
#pragma once

#include "platform/core/lanes_loops.h"

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

/// math::sin_cos() of finite angles up to 1e4 either way.
template <class L>
[[gnu::always_inline]] inline SineCosine<L> sine_cosine_of(typename L::F radians) {
  using F = typename L::F;
  const F turns = radians * 0.636619772367581F;
  const auto quarters = truncated(turns + with_sign(all<L>(0.5F), turns));
  const F n = as_float(quarters);
  return sine_cosine<L>(quarters, ((radians - n * 1.5703125F) - n * 4.837512969970703e-4F) - n * 7.549789954891882e-8F);
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

}  // namespace
}  // namespace touchline
