// SPDX-License-Identifier: Apache-2.0
// What the robot is told of its own motion: the gait's odometry, the IMU's yaw, and the camera's measured attitude.
// Each with the errors that such sensors have, all from a seed.
#pragma once

#include <cstdint>

#include "platform/core/rng.h"
#include "platform/host/sim/world.h"

namespace touchline::sim {

struct GaitErrors {
  float scale_x = 1.06F;  // the gait believes so much more (or less) than it does
  float scale_y = 0.95F;
  float scale_theta = 1.05F;
  float drift = radians(0.1F);          // radians a second of turn that the gait does not notice while walking
  float noise_xy = 0.011F;              // metres, 1 sigma, per square root of a second of walking
  float noise_theta = radians(1.4F);    // radians, likewise
  float seconds_between_slips = 12.0F;  // mean; 0: never
  float slip_share = 0.5F;              // of the commanded motion that a slipping foot loses
};

/// Step as the gait believes it.
class SimGait {
 public:
  SimGait(const GaitErrors& errors, std::uint64_t seed) : errors_(errors), rng_(seed, 8) {}
  /// `state.step` is what truly happened in `dt` seconds. A robot that lies or is carried reports no motion.
  Pose2 step(const WorldState& state, float dt);

 private:
  GaitErrors errors_;
  Rng rng_;
  float slip_left_ = 0.0F;  // seconds
};

struct ImuErrors {
  float noise = radians(0.15F);   // radians, 1 sigma, of each reading
  float drift = radians(0.05F);   // radians a second, constant
  float wander = radians(0.15F);  // radians per square root of a second
  float tilt = radians(0.5F);     // radians, 1 sigma, of the measured camera pitch and roll each
  float tilt_time = 1.5F;         // seconds over which most of that error stays the same
  float tilt_white_share = 0.3F;  // of the variance: new in each reading
  float goal_yaw = 0.0F;          // what the IMU reads toward the opponent's goal
};

/// Orientation as the IMU reports it.
class SimImu {
 public:
  SimImu(const ImuErrors& errors, std::uint64_t seed);
  /// Lets time pass; then yaw() and camera() answer for this state.
  void step(const WorldState& state, float dt);
  /// Continuous over full turns, radians.
  [[nodiscard]] float yaw() const { return yaw_; }
  /// The camera's pose with the measured pitch and roll; the rest is true.
  [[nodiscard]] const CameraPose& camera() const { return camera_; }

 private:
  ImuErrors errors_;
  Rng rng_;
  bool started_ = false;
  float heading_ = 0.0F;  // truth, unwrapped
  float bias_ = 0.0F;     // drift so far
  float pitch_error_ = 0.0F, roll_error_ = 0.0F;
  float yaw_ = 0.0F;
  CameraPose camera_;
};

}  // namespace touchline::sim
