// SPDX-License-Identifier: Apache-2.0
// Which skeleton points belong to a circle of known radius, and the centre that fits them best: Gauss-Newton on the
// ground, each point weighted by what a working pixel means where it lies.
#pragma once

#include <cstdint>
#include <span>

#include "platform/core/static_vector.h"
#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline {

inline constexpr float circle_gate = 2.5F;        // sigmas
inline constexpr float circle_band_radii = 0.4F;  // no point farther off, however little is known of it

/// Lengths in metres on the ground, in the robot's frame.
class CircleFit {
 public:
  /// `rays` and the points must outlive this.
  CircleFit(std::span<const ChainPoint> points, const WorkRays& rays, float radius_m, float line_width_m);

  /// One sigma of a skeleton point across the circle: what a pixel means in that direction, and the rag of a wide line.
  [[nodiscard]] float sigma(const GroundPoint& p, const GroundPoint& centre) const;
  /// Whether a point is within `sigmas` of the circle, how far outside it is, and one sigma.
  [[nodiscard]] bool near_circle(const GroundPoint& p, const GroundPoint& centre, float sigmas, float& off,
                                 float& sigma_m) const;
  /// Moves the centre to where the points near its circle say; `chi` is the root mean square of what is left, in
  /// sigmas. False where they say too little.
  bool refine(GroundPoint& centre, Sym2& information, float& chi) const;
  [[nodiscard]] Sym2 covariance(const GroundPoint& centre, const Sym2& information) const;

 private:
  /// Points in a wide band about a circle, by their index.
  struct Near {
    StaticVector<std::uint16_t, max_curve_points> points;
    GroundPoint centre;
  };
  [[nodiscard]] float sigma(const GroundPoint& p, const GroundPoint& centre, float apart) const;
  void gather(const GroundPoint& centre, Near& near) const;

  std::span<const ChainPoint> points_;
  const WorkRays& rays_;
  float radius_m_, line_width_m_;
  float towards2_, tilt2_, rag2_;  // parts of a bound of sigma squared
};

}  // namespace touchline
