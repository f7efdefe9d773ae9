// SPDX-License-Identifier: Apache-2.0
// The particle set as a structure of arrays, so that one loop runs over one quantity.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>

#include "loc/kernels.h"
#include "loc/localizer_config.h"
#include "platform/core/geometry.h"

namespace touchline {

/// `count` poses with log weights, in somebody else's memory.
struct ParticleView {
  float* x = nullptr;  // metres, field frame
  float* y = nullptr;
  float* theta = nullptr;       // radians, (-pi, pi]
  float* log_weight = nullptr;  // natural log, not normalised
  int count = 0;

  [[nodiscard]] Pose2 pose(int i) const {
    assert(i >= 0 && i < count);
    return {x[i], y[i], theta[i]};
  }
  void set_pose(int i, const Pose2& p) const {
    assert(i >= 0 && i < count);
    x[i] = p.x;
    y[i] = p.y;
    theta[i] = p.theta;
  }
};

template <std::size_t N>
struct ParticleStorage {
  std::array<float, N> x{}, y{}, theta{}, log_weight{};
  [[nodiscard]] ParticleView view(int count) {
    assert(count >= 0 && static_cast<std::size_t>(count) <= N);
    return {x.data(), y.data(), theta.data(), log_weight.data(), count};
  }
};

/// Up to sixteen of them from `first` on.
void take_poses(const ParticleView& particles, int first, const LocKernels& kernels, PoseBlock& block);

/// Subtracts the largest log weight, so that the best particle has 0; returns what was subtracted. Weights that are not
/// finite count as hopeless.
float normalize_log_weights(ParticleView particles);

}  // namespace touchline
