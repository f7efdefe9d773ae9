// SPDX-License-Identifier: Apache-2.0
// Motion update of the particles (Probabilistic Robotics, section 5.4: odometry model with noise per axis).
#pragma once

#include "loc/kernels.h"
#include "loc/localizer_config.h"
#include "loc/particles.h"
#include "platform/core/rng.h"

namespace touchline {

/// Standard deviations of one odometry step in the robot's frame.
struct StepSigma {
  float x = 0.0F;      // metres
  float y = 0.0F;      // metres
  float theta = 0.0F;  // radians
};
StepSigma step_sigma(const Pose2& step, const MotionNoise& noise);

/// Moves every particle by `step` (robot's frame) plus noise of its own.
void move_particles(ParticleView particles, const Pose2& step, const MotionNoise& noise, const LocKernels& kernels,
                    Rng& rng);

/// The next sixteen particles' worth.
void draw_noise(const LocKernels& kernels, Rng& rng, Noise& noise);

}  // namespace touchline
