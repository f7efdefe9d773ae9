// SPDX-License-Identifier: Apache-2.0
// The pose while there are no pictures: the last one, moved by odometry, less and less sure; in the end there is none.
#pragma once

#include "loc/localizer_config.h"
#include "loc/pose_estimate.h"

namespace touchline {

/// Motion since the pose before: what is known of it, and how much may be missing.
struct Motion {
  Pose2 step;                  // robot's frame
  float unknown_xy = 0.0F;     // metres, 1 sigma, beyond the noise of the step
  float unknown_theta = 0.0F;  // radians, likewise
};

/// Moves `estimate` and lets its uncertainty grow. Confidence halves in 3 s; with more than a metre or 0.6 rad (1
/// sigma) there is no pose any more.
void reckon(PoseEstimate& estimate, const Motion& motion, const MotionNoise& noise, float seconds);

}  // namespace touchline
