// SPDX-License-Identifier: Apache-2.0
// The places of junctions, made better by the line points: thinning bends a line where another one meets it, and moves
// the crossing by a working pixel or two; points on the middle of the lines, taken on the luma away from the crossing,
// do not know of that. Section IV-E's junctions, placed where the lines that were fitted to their branches cross.
#pragma once

#include "vision/features.h"
#include "vision/line_points.h"

namespace touchline {

/// Moves the places (`pixel`, `ground`, `covariance`) of the T's and L's of `features` to where the line points along
/// their branches say. A junction without such points stays where it is, and so does an X, whose place comes from the
/// fit of the centre circle; types, branches and confidences stay as they are.
/// A branch that is too short for line points gets its own: the line's direction is known there.
void place_junctions(const LinePointInput& input, Features& features);

}  // namespace touchline
