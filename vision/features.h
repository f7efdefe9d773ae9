// SPDX-License-Identifier: Apache-2.0
// What vision hands to localization: junctions, centre circle, goal posts and line points, on the ground in the robot's
// frame. Data only.
#pragma once

#include <array>
#include <cstdint>

#include "platform/core/geometry.h"
#include "platform/core/static_vector.h"

namespace touchline {

enum class JunctionType : std::uint8_t { l, t, x };
/// "L", "T" or "X".
const char* to_string(JunctionType type);

/// Why a candidate is no junction.
enum class JunctionRejection : std::uint8_t {
  none,
  no_ground,          // at or above the horizon, or beyond the lens
  too_far,            // beyond VisionConfig::max_range_m
  straight,           // two branches in one line: part of a line
  curved,             // two branches that bend evenly: part of the circle
  branch_too_short,   // no stretch of line long enough to measure a direction
  bad_angles,         // branches are not at right angles on the ground, as lines of a field are
  too_many_branches,  // more than four
  at_border,          // a branch is cut off by the edge of the ROI or of the image
  bridge,             // a short piece of white between two lines, a T at both ends
  duplicate,          // the same crossing as a better candidate beside it
};
const char* to_string(JunctionRejection reason);

struct Junction {
  JunctionType type = JunctionType::l;
  PixelPoint pixel;    // camera pixels, from lines fitted to the branches
  GroundPoint ground;  // robot's frame, metres
  Sym2 covariance;     // of `ground`, m^2: one pixel and the attitude's uncertainty
  int branches = 0;    // 2, 3 or 4
  /// Directions of the branches on the ground, away from the junction, robot's frame, radians.
  /// L: [0] and [1] with [1] counter-clockwise of [0] by about 90 degrees. T: [0] is the stem, [1] and [2] the bar,
  /// [1] counter-clockwise of the stem. X: in counter-clockwise order.
  std::array<float, 4> direction{};
  float confidence = 0.0F;  // (0, 1]: 1 for long straight branches at right angles near the axis
};

struct RejectedJunction {
  PixelPoint pixel;
  std::uint8_t branches = 0;
  JunctionRejection reason = JunctionRejection::none;
};

/// The centre circle, fitted on the ground to arcs of the node graph (the paper's future work).
struct CircleObservation {
  GroundPoint centre;
  Sym2 covariance;
  bool has_half_line = false;     // the half line through the centre was seen
  float half_line_direction = 0;  // robot's frame, radians in (-pi/2, pi/2]
  float arc = 0.0F;               // radians of the circle that were seen
  float confidence = 0.0F;
};

struct PostObservation {
  PixelPoint pixel;    // camera pixels: the post's axis at the ground
  GroundPoint ground;  // robot's frame
  Sym2 covariance;
  float confidence = 0.0F;
};

/// A point on the middle of a line. Zero before it is filled in, so that a static storage takes no room in flash.
struct LinePoint {
  PixelPoint pixel;    // camera pixels, better than a working pixel where the profile allows it
  GroundPoint ground;  // robot's frame, with the attitude as given
  float dir_x = 0.0F;  // unit direction of the line on the ground, robot's frame; dir_x > 0, or it is 0 and dir_y is 1
  float dir_y = 0.0F;
  float length = 0;  // metres of line on the ground that this point stands for
  float sigma = 0;   // metres on the ground, 1 sigma across the line, of one working pixel
};

inline constexpr std::size_t max_junctions = 32;  // a 14 x 9 m field has 2 X, 6 T, 16 L in all; the rest is clutter
inline constexpr std::size_t max_rejections = 128;
inline constexpr std::size_t max_posts = 4;          // both goals
inline constexpr std::size_t max_line_points = 512;  // about two working pixels apart on the longest skeletons seen

struct Features {
  StaticVector<Junction, max_junctions> junctions;
  StaticVector<RejectedJunction, max_rejections> rejections;
  bool has_circle = false;
  CircleObservation circle;
  StaticVector<PostObservation, max_posts> posts;
  StaticVector<LinePoint, max_line_points> line_points;
};

}  // namespace touchline
