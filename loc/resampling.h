// SPDX-License-Identifier: Apache-2.0
// Low-variance resampling (Probabilistic Robotics, table 4.4) and the effective number of particles.
#pragma once

#include "loc/particles.h"
#include "platform/core/rng.h"

namespace touchline {

/// 1 / sum of squared normalised weights: `count` when all are equal, 1 when one has everything.
float effective_count(ParticleView particles);

/// Draws `keep` particles (<= count) by weight into the first `keep` places, with one random number; their log weights
/// become 0. The places behind keep what they had and are the caller's to fill. `scratch` has the same count.
void resample_low_variance(ParticleView particles, int keep, ParticleView scratch, Rng& rng);

/// Of `count` particles the `share` in [0, 1], rounded down; 0 for a share that is no number.
int part_of(int count, float share);

/// Roughening (Gordon, Salmond, Smith 1993, "Novel approach to nonlinear/non-Gaussian Bayesian state estimation",
/// section 4): jitter of k * extent * n^(-1/3) an axis keeps the copies of a particle apart, and shrinks as the cloud
/// does.
void roughen(ParticleView particles, float k, Rng& rng);

}  // namespace touchline
