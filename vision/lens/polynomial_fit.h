// SPDX-License-Identifier: Apache-2.0
// Fits the constants of eqs. (3) and (4) of the paper (section V-B.2, Table I) to pairs of points: where the fish-eye
// shows a point, and where a pinhole of the same axis would show it.
#pragma once

#include <array>
#include <span>

#include "platform/core/geometry.h"
#include "platform/core/status.h"

namespace touchline {

struct PointPair {
  PixelPoint distorted;  // camera pixels, as seen
  PixelPoint pinhole;    // camera pixels, as the pinhole of `focal_px` and the same principal point would see it
};

struct PolynomialFitSettings {
  int degree = 5;         // 5 or 7, as in the paper
  float focal_px = 0.0F;  // of the pinhole
  PixelPoint principal_point;
  bool fit_a0 = false;  // false: a0 stays 0, because the axis of the lens is the axis of the pinhole. Left free, a0
                        // takes up what the degree cannot follow (minus 2 px and more), and the centre is blind
};

struct PolynomialFit {
  std::array<float, 8> a{};  // LensParameters::a
  std::array<float, 8> b{};  // LensParameters::b
  float max_theta = 0.0F;    // radians: the widest pair; beyond it the polynomial is a guess
  float rms_angle = 0.0F;    // radians between fitted and given ray, over the pairs
  float worst_angle = 0.0F;
};

/// Least squares of the angle from the axis (a pair's error of r_c counts cos^2 theta / f) and, for b, of the arc
/// length on the image. The pairs should cover the radius and the whole turn evenly. invalid_argument: a degree other
/// than 5 or 7, a focal length or a point that is no number, or pairs that do not determine the constants (too few, all
/// of one radius or one direction); `what` says which, when not null. `out` is then unchanged.
Status fit_polynomial(std::span<const PointPair> pairs, const PolynomialFitSettings& settings, PolynomialFit& out,
                      const char** what = nullptr);

}  // namespace touchline
