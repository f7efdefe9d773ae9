// SPDX-License-Identifier: Apache-2.0
// Low-variance resampling (Probabilistic Robotics, table 4.4) and the effective number of particles.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "loc/particles.h"
#include "platform/core/rng.h"

namespace touchline {

/// Working memory, one a particle.
struct ResamplingMemory {
  std::span<float> weights;
  std::span<std::uint16_t> drawn;
};
template <std::size_t N>
struct ResamplingStorage {
  static_assert(N <= 65'536, "particles are numbered with 16 bits");
  std::array<float, N> weights{};
  std::array<std::uint16_t, N> drawn{};
  [[nodiscard]] ResamplingMemory memory() { return {weights, drawn}; }
};

/// 1 / sum of squared normalised weights: `count` when all are equal, 1 when one has everything.
float effective_count(ParticleView particles);

/// Draws `keep` particles (<= count) by weight into the first `keep` places, with one random number; their log weights
/// become 0. The places behind keep what they had and are the caller's to fill. The memory has room for each particle.
void resample_low_variance(ParticleView particles, int keep, const ResamplingMemory& memory, Rng& rng);

/// Of `count` particles the `share` in [0, 1], rounded down; 0 for a share that is no number.
int part_of(int count, float share);

/// Roughening (Gordon, Salmond, Smith 1993, "Novel approach to nonlinear/non-Gaussian Bayesian state estimation",
/// section 4): jitter of k * extent * n^(-1/3) an axis keeps the copies of a particle apart, and shrinks as the cloud
/// does.
void roughen(ParticleView particles, float k, Rng& rng);

}  // namespace touchline
