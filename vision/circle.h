// SPDX-License-Identifier: Apache-2.0
// The centre circle from the arcs of the node graph (the future work that the paper names in section VII).
//
// Any three points of a chain that lie on a circle of the field's radius tell its centre; such votes are gathered, and
// the centre with the most is refined by least squares over all skeleton points near its circle, each weighted by what
// a pixel means there. It takes a connected arc of 60 degrees: two straight lines that meet touch a circle in two
// short pieces with a gap between, and a corner rounded by thinning is far too small.
#pragma once

#include "platform/core/static_vector.h"
#include "vision/features.h"
#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline {

struct CircleParameters {
  float radius_m = 0.75F;
  float line_width_m = 0.05F;
};

inline constexpr int circle_bins = 72;                // 5 degrees each
inline constexpr std::size_t max_circle_votes = 384;  // every third of max_curve_points, and pieces of arcs

struct CircleWork {
  StaticVector<GroundPoint, max_circle_votes> votes;
  bool seen[circle_bins] = {};  // parts of the circle that have line points, by angle about the centre
};

/// False when no circle is seen; then `circle` is unchanged. Sets on_circle of the segments that are its arcs.
bool find_circle(LineSegments& lines, const WorkRays& rays, const CircleParameters& parameters, CircleWork& work,
                 CircleObservation& circle);

}  // namespace touchline
