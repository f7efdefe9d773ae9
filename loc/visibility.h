// SPDX-License-Identifier: Apache-2.0
// The other direction of the test: lines that a pose says must be in the picture, and are not. Green carpet where a
// line should be speaks against a pose; a robot, a ball or the dark says nothing.
#pragma once

#include "loc/field.h"
#include "loc/refinement.h"
#include "vision/vision_result.h"

namespace touchline {

struct Visibility {
  float seen = 0.0F;     // metres of field line that the pose puts where the line mask has a line
  float missing = 0.0F;  // metres that it puts on green carpet without a line
};

/// Samples the field's lines every 0.15 m within `max_range` of the robot and projects them with the refined attitude.
Visibility check_visibility(const Field& field, const VisionResult& vision, const Refinement& refined, float max_range);

}  // namespace touchline
