// SPDX-License-Identifier: Apache-2.0
// Equidistant lens: r = f theta. Usual for fish-eyes beyond 180 degrees.
#pragma once

#include "platform/core/elementary.h"
#include "vision/lens/lens.h"

namespace touchline::equidistant {

inline float radius_from_theta(const LensParameters& lens, float theta) { return lens.focal_px * theta; }

inline float theta_from_radius(const LensParameters& lens, float radius) { return radius / lens.focal_px; }

}  // namespace touchline::equidistant
