// SPDX-License-Identifier: Apache-2.0
// Every parameter of the robot's loop: unit, default and reason. Those of vision and localization are in their own
// structs.
#pragma once

#include <cstdint>

#include "hal/camera_attitude.h"
#include "hal/odometry_history.h"
#include "loc/field.h"
#include "loc/localizer_config.h"
#include "platform/core/time.h"
#include "vision/lens/lens.h"
#include "vision/vision_config.h"

namespace touchline {

struct RobotConfig {
  VisionConfig vision;
  LensParameters lens;
  LocalizerConfig localizer;
  FieldDimensions field;
  Prior prior;             // where the robot may be at start
  std::uint64_t seed = 1;  // of the particles

  CameraMount mount;
  bool fixed_head = false;                // no neck: the torso's tilt alone gives the camera's attitude
  MonotonicNs camera_delay = 0;           // from the exposure to the driver's time stamp
  MonotonicNs camera_stall = one_second;  // no frame for this long: it is opened anew
  std::uint8_t black_below = 20;          // brightest of the sampled pixels, 0..255: a picture of nothing

  bool has_imu = true;
  bool goal_yaw_known = false;  // else the yaw is used once the button has stored it
  float goal_yaw = 0.0F;        // radians: what the IMU reads when the robot looks at the opponent's goal
  MonotonicNs imu_stale = 200 * one_millisecond;

  bool has_gait = true;
  MonotonicNs gait_stale = 300 * one_millisecond;
  MotionLimits motion_limits;
  float unknown_speed = 0.3F;        // m/s, 1 sigma: motion to reckon with where there is no odometry
  float unknown_turn = radians(20);  // rad/s, likewise; where the IMU is silent too

  bool has_panel = true;

  MonotonicNs reopen = 500 * one_millisecond;       // between tries to open a device that is missing
  MonotonicNs slice = 2 * one_millisecond;          // of waiting for a frame: the other devices are read in between
  MonotonicNs idle_after = 300 * one_millisecond;   // no picture that can be used for this long: reports without one
  MonotonicNs idle_report = 100 * one_millisecond;  // ... this often
  MonotonicNs transient = 2 * one_second;           // faults that are events (a jump, a restart) are shown this long
  MonotonicNs clock_leap = 5 * one_second;          // between two turns of the loop: no load explains that
};

}  // namespace touchline
