// SPDX-License-Identifier: Apache-2.0
#include "platform/core/angle.h"

#include <cstdint>

namespace touchline {

float wrap_far_angle(float angle) {
  if (angle == -math::pi) return math::pi;
  if (!(math::abs(angle) < 1.0e9F)) return angle != angle ? angle : 0.0F;
  // The nearest whole number of turns is taken off in double: its 53 bits leave 1e-7 even at 1e9.
  constexpr double turn = 6.283185307179586476925;
  const double wide = static_cast<double>(angle);
  if (math::abs(angle) < 9.0F) {  // one turn: the same difference without the division
    const auto wrapped = static_cast<float>(angle < 0.0F ? wide + turn : wide - turn);
    return wrapped > math::pi || wrapped <= -math::pi ? math::pi : wrapped;
  }
  const double turns = wide / turn;
  const std::int64_t whole = static_cast<std::int64_t>(turns < 0.0 ? turns - 0.5 : turns + 0.5);
  const float wrapped = static_cast<float>(wide - static_cast<double>(whole) * turn);
  if (wrapped > math::pi) return math::pi;
  return wrapped <= -math::pi ? math::pi : wrapped;
}

}  // namespace touchline
