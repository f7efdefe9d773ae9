// SPDX-License-Identifier: Apache-2.0
// What the robot's loop says after a frame, or while there is none. Data only.
#pragma once

#include <cstdint>

#include "hal/camera_attitude.h"
#include "hal/device_health.h"
#include "hal/panel.h"
#include "loc/pose_estimate.h"
#include "platform/core/time.h"
#include "platform/robot/fault.h"

namespace touchline {

struct RobotReport {
  std::uint64_t sequence = 0;  // of the reports
  MonotonicNs time = 0;        // that the pose belongs to: the frame's, or now
  bool from_frame = false;     // false: reckoned from odometry alone
  PoseEstimate estimate;
  bool yaw_used = false;       // the IMU's yaw took part
  bool odometry_used = false;  // false: the motion since the report before is unknown

  AttitudeSource attitude_source = AttitudeSource::config;
  CameraAttitude camera;
  MonotonicNs frame_to_pose = 0;  // from the frame's time stamp to the pose; 0 without a frame
  MonotonicNs processing = 0;     // from taking the frame to the pose; 0 without a frame
  std::uint64_t frames = 0;       // processed since start

  // Of the frame: what was seen.
  int junctions = 0;
  int posts = 0;
  int line_points = 0;
  int dropped = 0;  // items that found no room, all stages together

  FaultSet faults;
  LedPattern led = LedPattern::off;
  DeviceHealth camera_health, imu_health, gait_health, panel_health;
  std::uint32_t yaw_jumps = 0;
  std::uint32_t odometry_jumps = 0;
};

}  // namespace touchline
