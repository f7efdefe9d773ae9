// SPDX-License-Identifier: Apache-2.0
// The straight stretches of a node graph, on the ground. The lens bends every line, so a skeleton is judged by its
// rays: a straight line on the carpet and the camera span a plane, and the rays of the line's pixels lie in it. Each
// chain of edges is split where it leaves the plane (Ramer 1972, Douglas and Peucker 1973, with the distance to the
// chord as an angle), and a plane is fitted to the inside of each stretch by least squares.
#pragma once

#include <cstdint>

#include "platform/core/static_vector.h"
#include "vision/graph.h"
#include "vision/image/bit_image.h"
#include "vision/work_rays.h"

namespace touchline {

struct LineSegment {
  Vec3 normal;            // unit; of the plane through camera and line
  GroundPoint end[2];     // robot's frame, on the fitted line
  Vec3 end_ray[2];        // towards them, unit
  GroundPoint direction;  // unit vector from end[0] to end[1]
  float length = 0.0F;    // metres
  float sigma = 0.0F;     // of the direction, radians: half a working pixel at each end
  std::uint16_t chain = 0;
  std::uint16_t points = 0;
  bool is_short = false;   // its middle is good, its direction is not
  bool on_circle = false;  // set by the centre circle's fit
};

/// A skeleton point on the ground, in the order along its chain.
struct ChainPoint {
  GroundPoint ground;
  std::uint16_t chain = 0;
};

inline constexpr std::size_t max_segments = 96;  // twice what a field's lines in pieces and a circle in 16 came to
inline constexpr std::size_t max_straight_lines = 48;  // of them, once pieces are joined: the rest is clutter
inline constexpr std::size_t max_chain_points = 512;   // longer chains are thinned out
inline constexpr std::size_t max_curve_points = 768;   // of the frame; chains are thinned out to fit

struct LineSegments {
  StaticVector<LineSegment, max_segments> segments;
  StaticVector<ChainPoint, max_curve_points> points;  // for the circle's fit
  int left_out = 0;                                   // the shortest of too many straight lines
  // Working memory: the points of one chain, side by side for vectors.
  struct Chain {
    float x[max_chain_points] = {}, y[max_chain_points] = {};  // rays, robot's axes
    float z[max_chain_points] = {};                            // 0 where no ground is seen in reach
    float ground_x[max_chain_points] = {}, ground_y[max_chain_points] = {};
    [[nodiscard]] Vec3 ray(int i) const { return {x[i], y[i], z[i]}; }
    [[nodiscard]] GroundPoint ground(int i) const { return {ground_x[i], ground_y[i]}; }
  };
  Chain chain;
};

struct LineSegmentParameters {
  float line_width_m = 0.05F;
  float max_range_m = 6.0F;
};

/// What the colours say: line pixels, carpet (after dilation, so lines count as carpet too), region of interest.
struct FieldView {
  ConstBitView lines;
  ConstBitView green;
  ConstBitView carpet;  // the carpet's colour, pixel by pixel
  ConstBitView roi;     // may be empty (words == nullptr): the whole picture
};

/// `edge_done` has one entry an edge of the graph. Segments and points without room are counted in their dropped().
void find_line_segments(const NodeGraphView& graph, const WorkRays& rays, const FieldView& field,
                        const LineSegmentParameters& parameters, std::span<std::uint8_t> edge_done, LineSegments& out);

}  // namespace touchline
