// SPDX-License-Identifier: Apache-2.0
// math::atan2 without a branch, to be inlined into loops over many points: compilers turn those into vectors where the
// processor has them. Everywhere else math::atan2 is the same in less code.
#pragma once

#include <bit>
#include <cstdint>

#include "platform/core/elementary.h"

namespace touchline::math {

/// On [-tan(pi/8), tan(pi/8)]; relative error of the fit 2e-8.
inline float atan_polynomial(float x) {
  const float z = x * x;
  return x + x * z * (-0.333329552537F + z * (0.19977926086F + z * (-0.138798500442F + z * 8.0603091266e-2F)));
}

/// atan2(y, x); `select(condition, a, b)` is a where the condition holds, else b.
template <typename Select>
[[gnu::always_inline]] inline float atan2_by(float y, float x, Select select) {
  constexpr float tan_pi_8 = 0.414213562F;
  const float ax = abs(x);
  const float ay = abs(y);
  const float low = min(ax, ay);
  const float high = max(ax, ay);
  // atan(low / high), moved by pi/4 where the ratio is too large for the polynomial.
  const bool steep = low > tan_pi_8 * high;
  const float dividend = select(steep, low - high, low);
  const float divisor = select(steep, low + high, high);
  float angle = select(steep, 0.5F * half_pi, 0.0F) + atan_polynomial(dividend / divisor);
  angle = select(ay > ax, half_pi - angle, angle);
  angle = select(x < 0.0F, pi - angle, angle);
  const float turned = select(angle < pi, -angle, angle);  // -pi itself is outside the range
  angle = select(y < 0.0F, turned, angle);
  angle = select(high == 0.0F, 0.0F, angle);  // minus zero is zero
  return select((x != x) | (y != y), x + y, angle);
}

/// atan2(y, x), bit for bit. For vectors both sides of every choice are worked out and one is masked away: a compiler
/// must not do so by itself with sums that could trap.
[[gnu::always_inline]] inline float atan2_lane(float y, float x) {
#if defined(__SSE2__) || defined(__ARM_NEON)
  return atan2_by(y, x, [](bool condition, float a, float b) {
    const std::uint32_t mask = 0U - static_cast<std::uint32_t>(condition);
    return std::bit_cast<float>((std::bit_cast<std::uint32_t>(a) & mask) | (std::bit_cast<std::uint32_t>(b) & ~mask));
  });
#else
  return atan2_by(y, x, [](bool condition, float a, float b) { return condition ? a : b; });
#endif
}

}  // namespace touchline::math
