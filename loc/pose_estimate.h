// SPDX-License-Identifier: Apache-2.0
// What localization says after a frame. Data only.
#pragma once

#include "platform/core/geometry.h"

namespace touchline {

struct PoseCovariance {  // of (x, y, theta): m^2, m rad, rad^2
  float xx = 0, xy = 0, yy = 0, xt = 0, yt = 0, tt = 0;
};

struct PoseEstimate {
  bool valid = false;         // false: no pose (yet); the rest is then void
  Pose2 pose;                 // of the best cluster, never the mean over two modes
  PoseCovariance covariance;  // grows when other places (but for the mirrored one) are still in the race
  float confidence = 0.0F;    // [0, 1]: share of belief in this cluster, times how well it explains the picture
  bool settled = false;       // sure, and steady for three updates
  bool has_mirror = false;    // the mirrored pose is still in the race
  Pose2 mirror;
  float mirror_confidence = 0.0F;
  float explained = 0.0F;    // share of the seen line that lies on field lines (full model)
  float pitch_error = 0.0F;  // radians, estimated error of the mount's pitch and roll (full model)
  float roll_error = 0.0F;
  float yaw_drift = 0.0F;  // radians, estimated: IMU yaw minus theta
};

/// Belief in the pose up to the field's symmetry: without a yaw the two halves share what is known.
inline float certainty(const PoseEstimate& e) { return e.valid ? e.confidence + e.mirror_confidence : 0.0F; }

}  // namespace touchline
