// SPDX-License-Identifier: Apache-2.0
// What the steps of the junction search share: candidates, and how one is taken or turned down.
#pragma once

#include "platform/core/static_vector.h"
#include "vision/circle.h"
#include "vision/features.h"
#include "vision/field_sight.h"
#include "vision/line_segments.h"
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
inline constexpr std::size_t max_junction_candidates = 96;  // twice the most of a field; a frame of clutter fills them

/// Working memory.
struct JunctionWork {
  StaticVector<JunctionCandidate, max_junction_candidates> candidates;
};

/// The centre circle, where it was found (circle.h).
struct SeenCircle {
  const CircleObservation& observation;
  const bool* seen;  // circle_bins parts, by angle about the centre, from -pi
  float radius_m;
};

/// One frame's search.
struct JunctionSearch {
  const LineSegments& lines;
  const SeenCircle* circle;  // null: none was found
  const WorkRays& rays;
  const FieldView& field;
  const JunctionParameters& parameters;
  const FieldSight& sight;
  JunctionWork& work;
  Features& features;
};

// Field lines meet at right angles; tilt and an uneven carpet turn them by a degree or two on the ground.
inline constexpr float right_angle_sigma = radians(2.0F);
inline constexpr float right_angle_tolerance = radians(12.0F);
inline constexpr float max_angle_tolerance = radians(55.0F);
// The direction of a longer stretch is known this well; thinning turns short ones.
inline constexpr float long_line_sigma = radians(4.5F);

void reject_junction(const JunctionSearch& search, const JunctionCandidate& c, int branches, JunctionRejection reason);
/// `directions` has `count` branches in the order of Junction::direction; `quality` is in (0, 1].
void accept_junction(const JunctionSearch& search, const JunctionCandidate& c, JunctionType type,
                     const float* directions, int count, float quality);

/// Adds candidates where segment `i` meets one before it.
void find_line_crossings(const JunctionSearch& search, std::size_t i);
/// Adds candidates where the line mask shows a branch square to a segment, when that is long enough.
void scan_for_branches(const JunctionSearch& search, const LineSegment& segment);
/// Accepts the two X's where the half line cuts the centre circle.
void cut_circle(const JunctionSearch& search);
/// On the centre circle or inside it, where the half line is alone.
[[nodiscard]] bool on_centre_circle(const JunctionSearch& search, const GroundPoint& p);
/// Outside the centre circle, on the half line, with the circle's centre in `direction`.
[[nodiscard]] bool on_half_line(const JunctionSearch& search, const GroundPoint& p, float direction);

}  // namespace touchline
