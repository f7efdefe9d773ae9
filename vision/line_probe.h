// SPDX-License-Identifier: Apache-2.0
// Sixteen skeleton pixels on their way to line points, a quantity after the other, so that the kernels' loops take them
// side by side (line_points.cpp).
#pragma once

#include <cstdint>

#include "platform/core/geometry.h"

namespace touchline {

inline constexpr int probe_lanes = 16;
/// A line wider than that to a side, at a working width of up to 320, fills the picture.
inline constexpr int probe_half_width_px = 40;
inline constexpr int probe_side_px = 2;           // how far beyond the mask's edge the carpet is sampled
inline constexpr std::int32_t probe_one = 65536;  // fixed point of a pixel and of a level of luma
inline constexpr float probe_descent = 1.0e-4F;   // least of a ray that meets the ground

/// What has become of a pixel: still on its way, or why not.
using ProbeState = std::int32_t;
inline constexpr ProbeState probe_alive = 0, probe_no_direction = 1, probe_no_edge = 2, probe_no_ground = 3,
                            probe_wrong_width = 4;

using ProbeFloats = float[probe_lanes];
using ProbeInts = std::int32_t[probe_lanes];

/// Moments of the skeleton about each pixel (image/moments.h).
struct ProbeMoments {
  alignas(64) ProbeInts n = {}, x = {}, y = {}, xx = {}, xy = {}, yy = {};
};

/// The windows that they are taken from, all of one mask, wholly inside its memory: pixel x of a row is bit `shift` + x
/// of the four bytes there.
struct ProbeWindows {
  const std::uint8_t* bytes = nullptr;
  std::int32_t stride = 0;                        // bytes
  int columns = 0;                                // 1 to max_window_columns; moments are about columns / 2
  int radius = 0;                                 // of rows, 1 to max_moments_radius
  std::uint32_t asked = 0;                        // a bit for each window that is
  alignas(64) ProbeInts offset = {}, shift = {};  // of the first row, bytes; 0 to 7
};

struct LineProbes {
  int count = 0;
  alignas(64) ProbeInts x = {}, y = {};  // working pixels
  ProbeInts state = {};
  ProbeFloats tangent_u = {}, tangent_v = {};  // unit vector; the normal is (-tangent_v, tangent_u)
  ProbeFloats ahead = {}, back = {};           // distances of the line's edges from the pixel's centre, working pixels
  ProbeFloats middle_u = {}, middle_v = {};    // of the line in the working picture
  ProbeFloats half = {};                       // of its width there
  ProbeFloats dir_x = {}, dir_y = {};          // unit direction on the ground, robot's frame
  ProbeFloats length = {}, across = {};        // metres a working pixel, along the line and across
  // Of the edges, to both sides: from the principal point, in camera pixels; and the angle off the lens's axis.
  ProbeFloats edge_u[2] = {}, edge_v[2] = {}, radius[2] = {}, theta[2] = {};
  ProbeFloats ground_x = {}, ground_y = {};  // metres, robot's frame
  ProbeFloats off_middle = {};               // of the place of that ground point in the picture, along the normal
};

/// What they are looked for in: at least four columns and two rows.
struct ProbePicture {
  const std::uint8_t* luma = nullptr;
  const std::uint8_t* mask = nullptr;             // of bits
  std::int32_t luma_stride = 0, mask_stride = 0;  // bytes
  std::int32_t width = 0, height = 0;             // of both
  std::int32_t half_width = 0;  // how far to a side a line is followed, working pixels, at least probe_half_width_px
};

/// Where the camera is, and what its pixels see.
struct ProbeView {
  const float* rays = nullptr;  // x, y, z of each corner of the ray grid
  std::int32_t columns = 0, rows = 0;
  Mat3 robot_from_camera;
  float x = 0.0F, y = 0.0F, height = 0.0F;        // the camera, robot's frame
  float per_work_u = 1.0F, per_work_v = 1.0F;     // camera pixels a working pixel
  float cx = 0.0F, cy = 0.0F, max_radius = 0.0F;  // of the lens, camera pixels
  float line_width_m = 0.0F, max_range_m = 0.0F;
};

/// The steps, in this order. Each takes those that are alive, the first those without a direction.
struct ProbeKernels {
  /// Of the windows that are asked for; the others' are left as they are. Null: not offered.
  void (*moments)(const ProbeWindows& windows, ProbeMoments& moments) = nullptr;
  /// Main axis of at least `least` pixels, whose variance across is at most the share `most_across` of that along.
  void (*axes)(const ProbeMoments& moments, int least, float most_across, LineProbes& probes) = nullptr;
  void (*edges)(const ProbePicture& picture, LineProbes& probes) = nullptr;
  /// Compares their distance with the line's width.
  void (*widths)(const ProbeView& view, LineProbes& probes) = nullptr;
  /// With `theta` of both edges.
  void (*places)(const ProbeView& view, LineProbes& probes) = nullptr;
};

}  // namespace touchline
