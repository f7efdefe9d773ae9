// SPDX-License-Identifier: Apache-2.0
// Inverse of an increasing function on an interval: Newton's method, kept inside a shrinking bracket, so that it always
// ends and never leaves the interval.
#pragma once

#include "platform/core/elementary.h"

namespace touchline {

/// x in [low, high] with value(x) = target, for an increasing `value` with derivative `slope`; the nearer end when
/// target lies outside. At most 32 steps: the bisection alone then reaches the last bit; Newton usually needs three or
/// four.
template <typename Value, typename Slope>
float invert_increasing(Value value, Slope slope, float target, float low, float high, float guess) {
  const float tolerance = 1.0e-7F * (high - low);
  float x = math::clamp(guess, low, high);
  for (int i = 0; i < 32; ++i) {
    const float excess = value(x) - target;
    if (excess > 0.0F) {
      high = x;
    } else {
      low = x;
    }
    float next = x - excess / slope(x);
    if (!(next >= low && next <= high)) next = 0.5F * (low + high);
    const float step = math::abs(next - x);
    x = next;
    if (step <= tolerance) break;
  }
  return x;
}

}  // namespace touchline
