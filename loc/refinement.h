// SPDX-License-Identifier: Apache-2.0
// Gauss-Newton refinement of a pose on line points, with the camera's pitch and roll errors among the unknowns
// (iteratively re-weighted least squares; Hartley & Zisserman, appendix 6).
#pragma once

#include "loc/kernels.h"
#include "loc/observation.h"
#include "loc/pose_estimate.h"

namespace touchline {

/// What is known before the line points are looked at: Gaussian, independent where the covariance says so.
struct RefinementPrior {
  bool has_pose = false;
  Pose2 pose;
  PoseCovariance covariance;  // must be positive definite when has_pose
  bool has_yaw = false;
  float yaw = 0.0F;        // theta as the IMU has it, drift taken out
  float yaw_sigma = 0.0F;  // radians
  float tilt_sigma = radians(0.5F);
};

struct Refinement {
  Pose2 pose;
  PoseCovariance covariance;
  float pitch_error = 0.0F;  // radians to add to the given pitch
  float roll_error = 0.0F;
  float line_log_likelihood = 0.0F;  // minus the weighted sum of the samples' robust cost, nats, <= 0
  float explained = 0.0F;            // share of the samples' weight that lies on lines, [0, 1]
  bool converged = false;            // the last step was short and the system well-posed
};

/// `start` within about `reach` metres and 15 degrees. The reach of a line shrinks from step to step to 4 sigma.
Refinement refine_pose(const QuarterLines& lines, const LineSampleView& samples, const CameraPose& camera,
                       const Pose2& start, const RefinementPrior& prior, const LocKernels& kernels, float reach = 0.4F,
                       int steps = 8);

}  // namespace touchline
