// SPDX-License-Identifier: Apache-2.0
// Junctions of field lines (paper section IV-E): X with four branches, T with three, L with two at a right angle.
//
// The paper reads the type off a node's degree. A skeleton breaks at crossings, sheds spurs there, and splits an X into
// two T's, so the branches are counted on the ground: two straight stretches of the graph (line_segments.h) that meet
// at a right angle, each going up to the other, make a candidate; candidates at the same place are one, and its
// branches are those that are long enough to be lines. What is cut off by the border of the picture or ends behind an
// obstacle has no type, so beyond a missing branch the carpet has to be seen.
#pragma once

#include "platform/core/static_vector.h"
#include "vision/circle.h"
#include "vision/features.h"
#include "vision/image/bit_image.h"
#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline {

struct JunctionParameters {
  float line_width_m = 0.05F;
  float max_range_m = 6.0F;
};

struct JunctionBranch {
  float direction = 0.0F;  // on the ground, away from the junction
  float length = 0.0F;     // metres
  float sigma = 0.0F;      // of the direction, radians
  bool curved = false;     // an arc of the centre circle
  std::uint16_t segment = 0;
};
struct JunctionCandidate {
  Vec3 ray;
  GroundPoint ground;
  StaticVector<JunctionBranch, 8> branches;  // more than four are no junction; eight show that
};
inline constexpr std::size_t max_junction_candidates = 96;  // twice what a frame of clutter shows

/// Working memory.
struct JunctionWork {
  StaticVector<JunctionCandidate, max_junction_candidates> candidates;
};

/// Working memory of all stages from the graph to the junctions.
struct FeatureWork {
  LineSegments lines;
  CircleWork circle;
  JunctionWork junctions;
};

/// What can be seen of the carpet: green pixels and the region of interest.
struct CarpetView {
  ConstBitView green;
  ConstBitView roi;
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
int find_junctions(const LineSegments& lines, const SeenCircle* circle, const WorkRays& rays, const CarpetView& carpet,
                   const JunctionParameters& parameters, JunctionWork& work, Features& features);

}  // namespace touchline
