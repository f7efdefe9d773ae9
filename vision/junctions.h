// SPDX-License-Identifier: Apache-2.0
// Junctions of field lines (paper section IV-E): X with four branches, T with three, L with two at a right angle.
//
// The paper reads the type off a node's degree. A skeleton breaks at crossings, sheds spurs there, and splits an X into
// two T's, so the branches are counted on the ground: two straight stretches of the graph (line_segments.h) that meet
// at a right angle, each going up to the other in white, make a candidate; candidates at the same place are one. From
// there the line mask is followed in the four directions. What is cut off by the border of the picture or ends behind
// an obstacle has no type, so where a branch is missing the carpet has to be seen.
#pragma once

#include "vision/junction_search.h"
#include "vision/posts.h"

namespace touchline {

/// Working memory of all stages from the graph to the junctions.
struct FeatureWork {
  LineSegments lines;
  CircleWork circle;
  JunctionWork junctions;
  PostWork posts;
};

/// Appends to features.junctions and features.rejections. Returns how many junctions and candidates found no room.
/// With a circle (`circle` not null), segments flagged on_circle are its arcs, and X's are where the half line cuts it;
/// nothing else meets on a centre circle.
int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const FieldView& field,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features);

}  // namespace touchline
