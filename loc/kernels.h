// SPDX-License-Identifier: Apache-2.0
// The loops of localization that gain from wide vectors, as a table of functions that never changes. The caller's
// configuration holds it. Every table gives the same floats, bit for bit (tests/loc/kernels_test.cpp): each sum has one
// order, whatever the width of the registers.
#pragma once

#include <cstdint>

#include "loc/distance_field.h"
#include "loc/field.h"
#include "loc/observation.h"

namespace touchline {

inline constexpr int pose_lanes = 16;   // poses that are looked at together
inline constexpr int sample_lanes = 8;  // line samples, likewise; their sums are made in this order

/// Up to sixteen poses; theta in radians, with its sine and cosine.
struct PoseBlock {
  alignas(64) float x[pose_lanes] = {};
  float y[pose_lanes] = {};
  float theta[pose_lanes] = {};
  float sin[pose_lanes] = {};
  float cos[pose_lanes] = {};
  int count = 0;

  void push_back(const Pose2& pose);  // count < pose_lanes
};

/// One frame's line samples against the distance map. The cost of a sample at distance d is weight * robust_cost(d^2 /
/// variance) = weight * limit * d^2 / (2 limit variance + d^2), here with d in steps of the map.
struct LineTerms {
  DistanceCells map;
  int count = 0;
  float x[max_filter_samples], y[max_filter_samples];                    // robot's frame, in cells
  float double_cos[max_filter_samples], double_sin[max_filter_samples];  // of twice the direction
  float saturation[max_filter_samples];                                  // 2 limit variance, square steps
  float limit[max_filter_samples];                                       // nats: weight * limit
};

// Landmarks, one for a type that the field has not, centre mark, posts.
inline constexpr std::size_t max_places = max_field_landmarks + 3 + 1 + 4;
inline constexpr std::size_t max_sights = max_junctions + 1 + max_posts;

/// One frame's landmarks: each sight costs confidence * robust_cost(z^2) for the place that explains it best.
struct LandmarkTerms {
  struct Place {
    float x = 0.0F, y = 0.0F;  // field frame
    float direction = 0.0F;    // radians
  };
  struct Sight {
    float x = 0.0F, y = 0.0F;               // robot's frame
    float xx = 0.0F, xy = 0.0F, yy = 0.0F;  // inverse of the covariance; xy twice
    float direction = 0.0F;                 // radians, robot's frame
    float period = 0.0F;                    // radians after which the direction repeats
    float turn_weight = 0.0F;               // 1 / sigma of the direction; 0 when there is none
    float confidence = 0.0F;
    int first = 0, last = 0;  // its places
    int begin = 0;            // the place to look at first: the one that explained it last; changes no result
  };
  Place places[max_places];
  Sight sights[max_sights];
  int place_count = 0, sight_count = 0;
};

/// A quarter of the field's lines: all are mirrored in both axes.
struct QuarterLines {
  struct Line {
    float low, high, across;  // metres, >= 0
  };
  Line along_x[max_field_lines], along_y[max_field_lines];
  int along_x_count = 0, along_y_count = 0;
  float circle_radius = 0.0F;
};
QuarterLines quarter_lines(const Field& field);

/// One linearisation of the line samples' distances about a pose and two tilts (refinement.cpp).
struct RefineTerms {
  LineSampleView samples;
  QuarterLines lines;
  CameraPose camera;
  Vec3 pitch_axis, roll_axis;  // robot's axes
  Pose2 pose;
  float sin = 0.0F, cos = 1.0F;     // of the pose's theta
  float pitch = 0.0F, roll = 0.0F;  // radians
  float extra_variance = 0.0F;      // square metres, added to every sample's own
};
inline constexpr int refine_unknowns = 5;  // x, y, theta, pitch, roll
struct RefineSums {
  float hessian[refine_unknowns * (refine_unknowns + 1) / 2] = {};  // lower triangle, row by row
  float gradient[refine_unknowns] = {};
  float cost = 0.0F;       // nats
  float explained = 0.0F;  // weight of the samples, by how much they pull
  float weight = 0.0F;     // of all
};
inline constexpr int refine_sums = 23;  // of the three kinds above

/// Three independent normal numbers (mean 0, deviation 1) for each of sixteen particles.
inline constexpr int noise_block = 16;
struct Noise {
  alignas(32) float value[3][noise_block];
};
inline constexpr int noise_words = 3 * noise_block;  // random words that it takes

struct LocKernels {
  const char* name = nullptr;
  /// Nats >= 0, of each pose; `costs` has room for sixteen.
  void (*line_costs)(const LineTerms& terms, const PoseBlock& poses, float* costs) = nullptr;
  void (*landmark_costs)(LandmarkTerms& terms, const PoseBlock& poses, float* costs) = nullptr;
  /// Samples 0, 8, 16 ... are summed, then 1, 9, 17 ..., and so on; then the eight sums in pairs.
  void (*linearise)(const RefineTerms& terms, RefineSums& sums) = nullptr;
  /// math::sin_cos() of sixteen finite angles, up to 1e4 either way.
  void (*sin_cos)(const float* angles, float* sin, float* cos) = nullptr;
  void (*normals)(const std::uint32_t* words, Noise& noise) = nullptr;
};

/// For every processor.
[[nodiscard]] LocKernels portable_loc_kernels();
/// Those of processors without vector registers, for the tests elsewhere.
[[nodiscard]] LocKernels scalar_loc_kernels();
/// For x86-64 with AVX2; without a name where this build has none. The caller makes sure that the processor has the
/// instructions (platform/processor).
[[nodiscard]] LocKernels avx2_loc_kernels();
/// Likewise with AVX-512, of it F, BW, DQ, VL, VBMI and VNNI.
[[nodiscard]] LocKernels avx512_loc_kernels();

}  // namespace touchline
