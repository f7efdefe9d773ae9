// SPDX-License-Identifier: Apache-2.0
// Rectilinear lens, the pinhole: r = f tan(theta), theta < 90 degrees.
#pragma once

#include "platform/core/elementary.h"
#include "vision/lens/lens.h"

namespace touchline::rectilinear {

inline float radius_from_theta(const LensParameters& lens, float theta) { return lens.focal_px * math::tan(theta); }

inline float theta_from_radius(const LensParameters& lens, float radius) { return math::atan2(radius, lens.focal_px); }

}  // namespace touchline::rectilinear
