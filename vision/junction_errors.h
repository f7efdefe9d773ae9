// SPDX-License-Identifier: Apache-2.0
// What a junction's covariance on the ground is made of.
#pragma once

#include "platform/core/angle.h"

namespace touchline {

inline constexpr float junction_sigma_px = 1.0F;             // camera pixels, of the lines' crossing
inline constexpr float junction_sigma_tilt = radians(0.5F);  // an IMU's error

}  // namespace touchline
