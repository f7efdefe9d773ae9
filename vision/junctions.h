// SPDX-License-Identifier: Apache-2.0
// Junctions of field lines (paper section IV-E): X with four branches, T with three, L with two at a right angle.
//
// The paper reads the type off a node's degree. A skeleton breaks at crossings, sheds spurs there, and splits an X into
// two T's, so the branches are counted on the ground: two straight stretches of the graph (line_segments.h) that meet
// at a right angle, each going up to the other in white, make a candidate; candidates at the same place are one. From
// there the line mask is followed in the four directions. What is cut off by the border of the picture or ends behind
// an obstacle has no type, so where a branch is missing the carpet has to be seen.
#pragma once

#include "platform/core/static_vector.h"
#include "vision/circle.h"
#include "vision/features.h"
#include "vision/image/bit_image.h"
#include "vision/line_segments.h"
#include "vision/posts.h"
#include "vision/work_rays.h"

namespace touchline {

struct JunctionParameters {
  float line_width_m = 0.05F;
  float max_range_m = 6.0F;
};

/// Two stretches of line that meet at a right angle.
struct JunctionCandidate {
  GroundPoint ground;
  float heading = 0.0F;    // of the line that is known better
  float other = 0.0F;      // of the one across it
  float off_angle = 0.0F;  // what they are off from a right angle, before that is made use of
  float sigma = 0.0F;      // of the place, working pixels
  bool taken = false;      // part of a junction that has been judged
};
inline constexpr std::size_t max_junction_candidates = 192;  // a frame of clutter shows half as many

/// Working memory.
struct JunctionWork {
  StaticVector<JunctionCandidate, max_junction_candidates> candidates;
};

/// Working memory of all stages from the graph to the junctions.
struct FeatureWork {
  LineSegments lines;
  CircleWork circle;
  JunctionWork junctions;
  PostWork posts;
};

/// The centre circle, where it was found (circle.h).
struct SeenCircle {
  const CircleObservation& observation;
  const bool* seen;  // circle_bins parts, by angle about the centre, from -pi
  float radius_m;
};

/// Appends to features.junctions and features.rejections. Returns how many junctions and candidates found no room.
/// With a circle (`circle` not null), segments flagged on_circle are its arcs, and X's are where the half line cuts it;
/// nothing else meets on a centre circle.
int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const FieldView& field,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features);

}  // namespace touchline
