// SPDX-License-Identifier: Apache-2.0
// math::atan2 without a branch, to be inlined into loops over many points: compilers turn those into vectors where the
// processor has them. Everywhere else math::atan2 is the same in less code.
#pragma once

#include "platform/core/elementary.h"

namespace touchline::math {

/// On [-tan(pi/8), tan(pi/8)]; relative error of the fit 2e-8.
inline float atan_polynomial(float x) {
  const float z = x * x;
  return x + x * z * (-0.333329552537F + z * (0.19977926086F + z * (-0.138798500442F + z * 8.0603091266e-2F)));
}

/// atan2(y, x), bit for bit.
inline float atan2_lane(float y, float x) {
  constexpr float tan_pi_8 = 0.414213562F;
  const float ax = abs(x);
  const float ay = abs(y);
  const float low = min(ax, ay);
  const float high = max(ax, ay);
  // atan(low / high), moved by pi/4 where the ratio is too large for the polynomial.
  const bool steep = low > tan_pi_8 * high;
  const float dividend = steep ? low - high : low;
  const float divisor = steep ? low + high : high;
  float angle = (steep ? 0.5F * half_pi : 0.0F) + atan_polynomial(dividend / divisor);
  angle = ay > ax ? half_pi - angle : angle;
  angle = x < 0.0F ? pi - angle : angle;
  const float turned = angle < pi ? -angle : angle;  // -pi itself is outside the range
  angle = y < 0.0F ? turned : angle;
  angle = high == 0.0F ? 0.0F : angle;  // minus zero is zero
  return ((x != x) | (y != y)) ? x + y : angle;
}

}  // namespace touchline::math
