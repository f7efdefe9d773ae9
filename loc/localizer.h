// SPDX-License-Identifier: Apache-2.0
// Features and odometry in, pose out: the paper's sections V and VI, and the full model that goes past them.
#pragma once

#include <cstdint>

#include "loc/field.h"
#include "platform/core/geometry.h"
#include "platform/core/status.h"
#include "vision/stage.h"
#include "vision/vision_result.h"

namespace touchline {

enum class LocModel : std::uint8_t {
  paper,  // X, T, L (or posts) with eq. (5); no line points, no circle, no refinement
  full,   // all the picture has; the default
};
enum class Landmarks : std::uint8_t { lines, goalposts, both };
enum class PriorKind : std::uint8_t { uniform, own_half, touch_line, pose };

struct Prior {
  PriorKind kind = PriorKind::uniform;
  Pose2 pose;                          // PriorKind::pose
  float sigma_xy = 0.3F;               // metres
  float sigma_theta = radians(15.0F);  // radians
};

struct LocalizerInput {
  double time_s = 0.0;
  Pose2 odometry;        // robot's step since the update before, as the gait believes it
  bool has_yaw = false;
  float yaw = 0.0F;      // IMU yaw minus the stored goal yaw: theta up to noise and drift, radians
  bool moved_by_hand = false;  // fallen, lifted: the odometry is void and the pose may be anywhere near
};

struct PoseCovariance {  // of (x, y, theta): m^2, m rad, rad^2
  float xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;
};

struct PoseEstimate {
  bool valid = false;          // false: no pose (yet); the rest is then void
  Pose2 pose;                  // of the best cluster, never the mean over two modes
  PoseCovariance covariance;
  float confidence = 0.0F;     // [0, 1]: share of belief in this cluster, and how well it explains the picture
  bool has_mirror = false;     // the mirrored pose is still in the race
  Pose2 mirror;
  float mirror_confidence = 0.0F;
  float pitch_error = 0.0F;    // radians, estimated error of the mount's pitch and roll (full model)
  float roll_error = 0.0F;
  float yaw_drift = 0.0F;      // radians, estimated: IMU yaw minus theta
};

}  // namespace touchline
