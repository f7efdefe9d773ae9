// SPDX-License-Identifier: Apache-2.0
#include "loc/motion_model.h"

#include "platform/core/elementary.h"

namespace touchline {

StepSigma step_sigma(const Pose2& step, const MotionNoise& noise) {
  const float way = math::hypot(step.x, step.y);
  const float turn = math::abs(step.theta);
  const float along = math::abs(step.x) * noise.xy_per_metre + turn * noise.xy_per_radian + noise.xy_floor;
  // A side step slips more than a step ahead, and a step ahead drifts sideways too: both axes share half of the other's
  // way.
  const float across = math::abs(step.y) * noise.xy_per_metre + turn * noise.xy_per_radian + noise.xy_floor;
  const float shared = 0.5F * noise.xy_per_metre;
  return {along + shared * math::abs(step.y), across + shared * math::abs(step.x),
          way * noise.theta_per_metre + turn * noise.theta_per_radian + noise.theta_floor};
}

void move_particles(ParticleView particles, const Pose2& step, const MotionNoise& noise, Rng& rng) {
  const StepSigma sigma = step_sigma(step, noise);
  for (int i = 0; i < particles.count; ++i) {
    const Pose2 noisy{step.x + sigma.x * rng.gaussian(), step.y + sigma.y * rng.gaussian(),
                      step.theta + sigma.theta * rng.gaussian()};
    particles.set_pose(i, compose(particles.pose(i), noisy));
  }
}

}  // namespace touchline
