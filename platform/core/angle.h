// SPDX-License-Identifier: Apache-2.0
// Angles: radians in code, degrees only in files and on screens.
#pragma once

#include "platform/core/elementary.h"

namespace touchline {

constexpr float radians(float degrees) { return degrees * 0.017453292519943295F; }
constexpr float degrees(float radians) { return radians * 57.295779513082321F; }

float wrap_far_angle(float angle);  // where wrap_angle() has to do something
/// The same direction in (-pi, pi]. Exact for angles already there; bounded time for any angle. From 1e9 on a float's
/// steps are wider than a turn and there is no direction left: 0. NaN stays NaN.
inline float wrap_angle(float angle) { return angle > -math::pi && angle <= math::pi ? angle : wrap_far_angle(angle); }
/// to - from, in (-pi, pi].
inline float angle_difference(float to, float from) { return wrap_angle(to - from); }

}  // namespace touchline
