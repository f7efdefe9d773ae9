// SPDX-License-Identifier: Apache-2.0
// The truth: where the robot, the other robots and the ball are, and how the camera hangs while the robot walks. A
// humanoid's walk: about 0.2 m/s, the head swaying with the steps, halts, turns on the spot, falls, kidnaps.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loc/field.h"
#include "platform/core/rng.h"
#include "vision/lens/camera_pose.h"

namespace touchline::sim {

enum class Activity : std::uint8_t { walking, turning, halted, fallen, lifted };

struct WalkOptions {
  FieldDimensions field;
  std::uint64_t seed = 1;
  float speed = 0.20F;                                               // metres a second, ahead
  float turn_rate = 0.6F;                                            // radians a second at the most
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};  // at rest
  float step_period = 0.667F;                                        // seconds for two steps
  float sway_pitch = radians(2.0F);
  float sway_roll = radians(3.0F);
  float sway_height = 0.0096F;         // metres
  float seconds_between_falls = 0.0F;  // mean; 0: never
  int robots = 2;                      // others, that walk too
};

struct WorldState {
  double time_s = 0.0;
  Pose2 pose;         // field_from_robot
  Pose2 step;         // true motion since the step before, in the robot's frame then; a kidnap does not count
  CameraPose camera;  // true, at this time
  Activity activity = Activity::walking;
  bool kidnapped = false;  // moved by hand since the step before
  float phase = 0.0F;      // of the step, radians
};

class SimWorld {
 public:
  explicit SimWorld(const WalkOptions& options);

  /// Time goes on by `dt` seconds, 0 < dt <= 0.2.
  void step(float dt);
  /// At the next step the robot is somewhere else, and nobody tells: activity and flags do not change.
  void kidnap(const Pose2& to);
  void kidnap_anywhere();
  /// Lies on the ground for `seconds`, then gets up where it fell.
  void fall(float seconds);
  /// Carried for `seconds` and put down at `to`; the activity says so.
  void lift(float seconds, const Pose2& to);
  /// Walks to the centre circle and turns once about itself.
  void turn_on_centre();

  [[nodiscard]] const WorldState& state() const { return state_; }
  [[nodiscard]] std::span<const Pose2> robots() const { return robots_; }
  [[nodiscard]] const FieldPoint& ball() const { return ball_; }
  [[nodiscard]] const WalkOptions& options() const { return options_; }

 private:
  [[nodiscard]] FieldPoint random_point(float inset);
  void steer(float dt);
  void choose_next();
  void walk(float dt);
  void lie(float dt);
  void sway(float dt);
  void move_others(float dt);

  WalkOptions options_;
  Rng rng_;
  WorldState state_;
  FieldPoint goal_;                                     // where the robot is going
  bool centre_next_ = false;                            // ... is the centre, to turn there
  float ahead_ = 0.0F, sideways_ = 0.0F, turn_ = 0.0F;  // velocities, robot's frame
  float want_ahead_ = 0.0F, want_turn_ = 0.0F;
  float remaining_ = 0.0F;  // seconds or radians that the activity still takes
  Pose2 put_down_;
  bool move_pending_ = false;
  Pose2 move_to_;
  float down_roll_ = 0.0F;
  float stride_ = 0.0F;  // 0..1: how much the body sways
  std::vector<Pose2> robots_;
  std::vector<FieldPoint> robot_goals_;
  FieldPoint ball_;
};

}  // namespace touchline::sim
