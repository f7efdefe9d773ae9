// SPDX-License-Identifier: Apache-2.0
// How well one pose explains one frame: line points against the distance map, oriented junctions, centre circle, posts
// and yaw, each with the robust cost of robust.h. The full model's observation likelihood.
#pragma once

#include "loc/distance_field.h"
#include "loc/field.h"
#include "loc/localizer_config.h"
#include "loc/observation.h"

namespace touchline {

/// What the IMU says of theta for this frame.
struct YawEvidence {
  bool known = false;
  float theta = 0.0F;  // radians, drift taken out
  float sigma = 0.0F;  // radians, noise and drift's uncertainty
};

/// Squared normalised difference of theta to the yaw; 0 when the yaw is not known.
float yaw_z2(const YawEvidence& yaw, float theta);

/// Nats, <= 0, weighted sum over observation.filter_lines. `extra_sigma` (metres) widens every sample: the distance
/// from a particle to the true pose that should still count.
float line_log_likelihood(const DistanceField& map, const Observation& observation, const Pose2& pose,
                          float extra_sigma);

/// Nats, <= 0, of junctions, circle and posts, as `landmarks` allows.
float landmark_log_likelihood(const Field& field, const Observation& observation, Landmarks landmarks,
                              const Pose2& pose, float extra_sigma);

/// Yaw: a wrapped Gaussian that does not saturate until 5 sigma, so that lines cannot turn the robot about.
float yaw_log_likelihood(const YawEvidence& yaw, float theta);

}  // namespace touchline
