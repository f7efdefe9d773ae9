// SPDX-License-Identifier: Apache-2.0
#include "loc/motion_model.h"

#include <algorithm>

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

void take_poses(const ParticleView& particles, int first, const LocKernels& kernels, PoseBlock& block) {
  block.count = std::min(particles.count - first, pose_lanes);
  for (int i = 0; i < block.count; ++i) {
    block.x[i] = particles.x[first + i];
    block.y[i] = particles.y[first + i];
    block.theta[i] = particles.theta[first + i];
  }
  kernels.sin_cos(block.theta, block.sin, block.cos);
}

void draw_noise(const LocKernels& kernels, Rng& rng, Noise& noise) {
  std::uint32_t words[noise_words];
  rng.next_u32s(words, noise_words);
  kernels.normals(words, noise);
}

void move_particles(ParticleView particles, const Pose2& step, const MotionNoise& noise, const LocKernels& kernels,
                    Rng& rng) {
  const StepSigma sigma = step_sigma(step, noise);
  Noise drawn;
  for (int first = 0; first < particles.count; first += pose_lanes) {
    const int at = first % noise_block;
    if (at == 0) draw_noise(kernels, rng, drawn);
    PoseBlock block;
    take_poses(particles, first, kernels, block);
    for (int i = 0; i < pose_lanes; ++i) {  // plain, so that it becomes vectors
      const float x = step.x + sigma.x * drawn.value[0][at + i];
      const float y = step.y + sigma.y * drawn.value[1][at + i];
      block.x[i] += block.cos[i] * x - block.sin[i] * y;
      block.y[i] += block.sin[i] * x + block.cos[i] * y;
      block.theta[i] += step.theta + sigma.theta * drawn.value[2][at + i];
    }
    for (int i = 0; i < block.count; ++i) {
      particles.set_pose(first + i, {block.x[i], block.y[i], wrap_angle(block.theta[i])});
    }
  }
}

}  // namespace touchline
