// SPDX-License-Identifier: Apache-2.0
// Every parameter of localization: unit, default and reason.
#pragma once

#include <cstdint>

#include "loc/kernels.h"
#include "platform/core/angle.h"
#include "platform/core/geometry.h"

namespace touchline {

enum class LocModel : std::uint8_t {
  paper,  // X, T, L (or posts) with eq. (5); no line points, no circle, no refinement
  full,   // all the picture has; the default
};
enum class Landmarks : std::uint8_t { lines, goalposts, both };
enum class PriorKind : std::uint8_t {
  uniform,     // anywhere on the carpet
  own_half,    // anywhere in the own half: kick-off
  touch_line,  // on either touch line, facing the field, in the own half: return after a penalty
  pose,        // near a pose
};

struct Prior {
  PriorKind kind = PriorKind::uniform;
  Pose2 pose;                          // PriorKind::pose
  float sigma_xy = 0.3F;               // metres, PriorKind::pose
  float sigma_theta = radians(15.0F);  // radians, PriorKind::pose and touch_line
};

/// Noise of one odometry step, 1 sigma (Thrun, Burgard, Fox, "Probabilistic Robotics", section 5.4, per axis).
/// A humanoid slips: a tenth to a fifth of the way is usual on carpet.
struct MotionNoise {
  float xy_per_metre = 0.15F;      // m of error along and across, per metre walked
  float xy_per_radian = 0.03F;     // m of error per radian turned
  float theta_per_metre = 0.15F;   // rad of error per metre walked
  float theta_per_radian = 0.15F;  // rad of error per radian turned
  float xy_floor = 0.002F;         // m a step, also while standing: a humanoid sways
  float theta_floor = 0.002F;      // rad a step
};

/// Paper section V-A and reading notes on eq. (1).
struct FeatureManagerConfig {
  float gamma = 50.0F;     // frames; decay constant of eq. (1)
  float threshold = 0.3F;  // a feature with less confidence is forgotten: 60 frames after a single sighting
  float gate_m = 0.35F;    // a sighting nearer than this to a remembered feature is the same feature
  float validation_gate_m =
      0.60F;  // with a sure pose, a feature farther than this from any landmark of its type is bogus
  // Base likelihood per type: how often a reported feature of the type is one (X is hard to mistake, L is easy).
  float base_l = 0.7F, base_t = 0.8F, base_x = 0.9F, base_post = 0.8F;
  float axis_half_angle = radians(60.0F);  // angle from the optical axis at which confidence has halved
};

struct AugmentedMclConfig {  // Probabilistic Robotics, table 8.3
  float alpha_slow = 0.05F;
  float alpha_fast = 0.4F;
  float random_share = 0.02F;  // always new, so that a kidnap can be noticed at all
};

inline constexpr int max_particles = 1000;

struct LocalizerConfig {
  LocModel model = LocModel::full;
  Landmarks landmarks = Landmarks::lines;
  int particles = 200;  // paper section VII
  MotionNoise motion;
  FeatureManagerConfig features;
  AugmentedMclConfig augmented;

  float yaw_sigma = radians(3.0F);        // rad, IMU yaw noise with its drift taken out
  float yaw_drift_rate = radians(0.1F);   // rad / sqrt(s): how fast the drift may walk
  float tilt_sigma = radians(0.5F);       // rad, error of the given pitch and roll, each
  float landmark_variance_floor = 0.05F;  // m^2, floor of sigma_l^2 in eq. (5), which shrinks as the cloud does
  float line_sigma_floor = 0.012F;        // m: paint, carpet and calibration are no better

  float confident = 0.80F;  // confidence from which a pose counts as sure

  /// Wider vectors where the processor has them (fastest_loc_kernels() of platform/processor); the result is the same.
  LocKernels kernels = portable_loc_kernels();
};

}  // namespace touchline
