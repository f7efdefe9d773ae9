// SPDX-License-Identifier: Apache-2.0
// The slow drift of the IMU's yaw against the field: a one-state Kalman filter, fed by sure poses only, so that the
// drift neither turns the pose nor, after minutes, picks the wrong half.
#pragma once

#include "loc/full_likelihood.h"
#include "platform/core/angle.h"

namespace touchline {

class YawTracker {
 public:
  void reset() { *this = YawTracker{}; }
  /// Time passes: the drift may have walked by `rate` rad / sqrt(s).
  void predict(float seconds, float rate) { variance_ += rate * rate * seconds; }
  /// A sure pose with heading `theta` (variance in rad^2) while the IMU reads `yaw`. Innovations beyond 20 degrees are
  /// not drift but a wrong pose or an IMU that was restarted, and are left out.
  void correct(float yaw, float theta, float theta_variance, float yaw_sigma) {
    const float innovation = angle_difference(yaw, theta + drift_);
    if (math::abs(innovation) > radians(20.0F)) return;
    const float gain = variance_ / (variance_ + yaw_sigma * yaw_sigma + theta_variance);
    drift_ = wrap_angle(drift_ + gain * innovation);
    variance_ *= 1.0F - gain;
  }
  [[nodiscard]] YawEvidence evidence(float yaw, float yaw_sigma) const {
    return {true, wrap_angle(yaw - drift_), math::sqrt(yaw_sigma * yaw_sigma + variance_)};
  }
  [[nodiscard]] float drift() const { return drift_; }

 private:
  float drift_ = 0.0F;
  float variance_ = radians(1.0F) * radians(1.0F);  // the goal's yaw is stored by hand: about a degree
};

}  // namespace touchline
