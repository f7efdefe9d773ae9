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

/// Some points beside a circle, side by side for vectors, and what follows from them. Metres on the ground.
struct RimPoints {
  static constexpr int most = 32;
  int count = 0;
  float x[most], y[most];  // in the robot's frame
  float dx[most], dy[most];
  float off[most];    // how far outside the circle
  float sigma[most];  // one sigma of that
};

/// Lengths in metres on the ground, in the robot's frame.
class CircleFit {
 public:
  /// `rays` and the points must outlive this.
  CircleFit(std::span<const ChainPoint> points, const WorkRays& rays, float radius_m, float line_width_m);

  /// One sigma of a skeleton point across the circle: what a pixel means in that direction, and the rag of a wide line.
  [[nodiscard]] float sigma(const GroundPoint& p, const GroundPoint& centre) const;
  /// Whether a point is seen as one of the circle, by what measure() has found of it.
  [[nodiscard]] bool near_circle(float off, float sigma_m, float sigmas) const {
    const bool in_reach = math::abs(off) <= circle_band_radii * radius_m_;
    return in_reach & (math::abs(off) < sigmas * sigma_m);  // without a branch, for vectors
  }
  /// Whether a point may be: told by the square of its distance from the centre, with a little room.
  [[nodiscard]] bool in_band(float squared) const { return squared <= band_outer2_ && squared >= band_inner2_; }
  /// Fills in all but x and y.
  void measure(const GroundPoint& centre, RimPoints& rim) const;
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
  /// Sums of a step of Gauss-Newton.
  struct Normals {
    Sym2 information;
    float bx = 0.0F, by = 0.0F, squares = 0.0F, count = 0.0F;
  };
  void add(const GroundPoint& centre, RimPoints& rim, Normals& sums) const;
  void gather(const GroundPoint& centre, Near& near) const;

  std::span<const ChainPoint> points_;
  const WorkRays& rays_;
  float radius_m_, line_width_m_;
  float band_inner2_, band_outer2_;
};

}  // namespace touchline
