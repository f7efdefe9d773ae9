// SPDX-License-Identifier: Apache-2.0
// The places of junctions, made better by the line points: thinning bends a line where another one meets it, and moves
// the crossing by a working pixel or two; points on the middle of the lines, taken on the luma away from the crossing,
// do not know of that. Section IV-E's junctions, placed where the lines that were fitted to their branches cross.
#pragma once

#include "vision/features.h"
#include "vision/lens/camera_pose.h"

namespace touchline {

struct JunctionPlaceParameters {
  float line_width_m = 0.05F;
  float camera_px_per_work_px = 1.0F;  // the graph is known to a working pixel, the rest is in camera pixels
};

/// Moves the places (`pixel`, `ground`, `covariance`) of the T's and L's of `features` to where the line points along
/// their branches say. A junction without such points stays where it is, and so does an X, whose place comes from the
/// fit of the centre circle; types, branches and confidences stay as they are.
void place_junctions(const GroundProjection& projection, const JunctionPlaceParameters& parameters, Features& features);

}  // namespace touchline
