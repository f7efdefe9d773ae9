// SPDX-License-Identifier: Apache-2.0
// Equisolid-angle lens: r = 2 f sin(theta / 2). Equal solid angles cover equal areas of the image.
#pragma once

#include "platform/core/elementary.h"
#include "vision/lens/lens.h"

namespace touchline::equisolid {

inline float radius_from_theta(const LensParameters& lens, float theta) {
  return 2.0F * lens.focal_px * math::sin(0.5F * theta);
}

inline float theta_from_radius(const LensParameters& lens, float radius) {
  return 2.0F * math::asin(radius / (2.0F * lens.focal_px));
}

}  // namespace touchline::equisolid
