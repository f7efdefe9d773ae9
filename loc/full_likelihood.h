// SPDX-License-Identifier: Apache-2.0
// How well a pose explains one frame: line points against the distance map, oriented junctions, centre circle, posts
// and yaw, each with the robust cost of robust.h. The full model's observation likelihood. What does not depend on the
// pose is prepared once a frame; the kernels do the rest.
#pragma once

#include "loc/kernels.h"
#include "loc/localizer_config.h"

namespace touchline {

/// What the IMU says of theta for this frame.
struct YawEvidence {
  bool known = false;
  float theta = 0.0F;  // radians, drift taken out
  float sigma = 0.0F;  // radians, noise and drift's uncertainty
};

/// Squared normalised difference of theta to the yaw; 0 when the yaw is not known.
float yaw_z2(const YawEvidence& yaw, float theta);

/// Every `step`-th of observation.filter_lines. `extra_sigma` (metres) widens every sample: the distance from a
/// particle to the true pose that should still count.
void prepare_lines(const DistanceField& map, const Observation& observation, float extra_sigma, std::size_t step,
                   LineTerms& out);
/// Junctions, circle and posts, as `landmarks` allows.
void prepare_landmarks(const Field& field, const Observation& observation, Landmarks landmarks, float extra_sigma,
                       LandmarkTerms& out);

/// Nats, <= 0, of one pose.
float line_log_likelihood(const LineTerms& terms, const Pose2& pose, const LocKernels& kernels);
float landmark_log_likelihood(LandmarkTerms& terms, const Pose2& pose, const LocKernels& kernels);

/// Yaw: a wrapped Gaussian that does not saturate until 5 sigma, so that lines cannot turn the robot about.
float yaw_log_likelihood(const YawEvidence& yaw, float theta);

}  // namespace touchline
