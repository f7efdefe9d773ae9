// SPDX-License-Identifier: Apache-2.0
// Polynomial regression, eqs. (3) and (4) of the paper: r_c = a0 + a1 r_d + ... + a7 r_d^7 in camera pixels from the
// principal point, theta = atan(r_c / f), and phi_c = b0 + b1 phi_d + ... + b7 phi_d^7 for the polar angle: radians in
// (-pi, pi], from the image's x axis toward its y axis. Degree 5 leaves a6, a7, b6, b7 at 0.
#pragma once

#include <array>

#include "platform/core/elementary.h"
#include "vision/lens/invert.h"
#include "vision/lens/lens.h"

namespace touchline::polynomial {

/// The polynomial's value at x, by Horner's rule.
inline float evaluate(const std::array<float, 8>& c, float x) {
  return c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * (c[5] + x * (c[6] + x * c[7]))))));
}

/// The polynomial's derivative at x.
inline float slope(const std::array<float, 8>& c, float x) {
  return c[1] + x * (2.0F * c[2] +
                     x * (3.0F * c[3] + x * (4.0F * c[4] + x * (5.0F * c[5] + x * (6.0F * c[6] + x * 7.0F * c[7])))));
}

/// A small negative a0 would turn the ray around at the very centre: there theta is 0.
inline float theta_from_radius(const LensParameters& lens, float radius) {
  return math::atan2(math::max(evaluate(lens.a, radius), 0.0F), lens.focal_px);
}

/// `max_radius` bounds the search.
inline float radius_from_theta(const LensParameters& lens, float theta, float max_radius) {
  return invert_increasing([&lens](float r) { return evaluate(lens.a, r); },
                           [&lens](float r) { return slope(lens.a, r); }, lens.focal_px * math::tan(theta), 0.0F,
                           max_radius, lens.focal_px * theta);
}

/// The pinhole's polar angle of a distorted one.
inline float corrected_angle(const LensParameters& lens, float phi) { return evaluate(lens.b, phi); }

/// The inverse. The image of (-pi, pi] is a turn, but begins elsewhere: the angle is moved into it by whole turns.
inline float distorted_angle(const LensParameters& lens, float phi) {
  if (phi > evaluate(lens.b, math::pi)) phi -= math::two_pi;
  if (phi < evaluate(lens.b, -math::pi)) phi += math::two_pi;
  return invert_increasing([&lens](float p) { return evaluate(lens.b, p); },
                           [&lens](float p) { return slope(lens.b, p); }, phi, -math::pi, math::pi, phi);
}

}  // namespace touchline::polynomial
