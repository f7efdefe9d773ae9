// SPDX-License-Identifier: Apache-2.0
// Kannala and Brandt, "A generic camera model and calibration method for conventional, wide-angle, and fish-eye
// lenses", PAMI 2006: r = f (theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9). There is no closed inverse.
#pragma once

#include "platform/core/elementary.h"
#include "vision/lens/invert.h"
#include "vision/lens/lens.h"

namespace touchline::kannala_brandt {

inline float radius_from_theta(const LensParameters& lens, float theta) {
  const float z = theta * theta;
  const float factor = 1.0F + z * (lens.k[0] + z * (lens.k[1] + z * (lens.k[2] + z * lens.k[3])));
  return lens.focal_px * theta * factor;
}

/// dr / dtheta.
inline float radius_slope(const LensParameters& lens, float theta) {
  const float z = theta * theta;
  return lens.focal_px *
         (1.0F + z * (3.0F * lens.k[0] + z * (5.0F * lens.k[1] + z * (7.0F * lens.k[2] + z * 9.0F * lens.k[3]))));
}

inline float theta_from_radius(const LensParameters& lens, float radius) {
  return invert_increasing([&lens](float theta) { return radius_from_theta(lens, theta); },
                           [&lens](float theta) { return radius_slope(lens, theta); }, radius, 0.0F, lens.max_theta,
                           radius / lens.focal_px);
}

}  // namespace touchline::kannala_brandt
