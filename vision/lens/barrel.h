// SPDX-License-Identifier: Apache-2.0
// Barrel distortion, eq. (2) of the paper: r_c = r_d / (1 - alpha r_d^2), in camera pixels from the principal point.
// r_c is the radius in the pinhole's image, hence theta = atan(r_c / f). At r_d = 1/sqrt(alpha) there is a pole, where
// theta reaches 90 degrees: at and beyond it there is no ray.
#pragma once

#include "platform/core/elementary.h"
#include "vision/lens/lens.h"

namespace touchline::barrel {

inline float theta_from_radius(const LensParameters& lens, float radius) {
  return math::atan2(radius, lens.focal_px * (1.0F - lens.alpha * radius * radius));
}

/// Solves alpha r_c r_d^2 + r_d - r_c = 0 in the form that does not cancel, and also holds for alpha = 0.
inline float radius_from_theta(const LensParameters& lens, float theta) {
  const float corrected = lens.focal_px * math::tan(theta);
  return 2.0F * corrected / (1.0F + math::sqrt(1.0F + 4.0F * lens.alpha * corrected * corrected));
}

}  // namespace touchline::barrel
