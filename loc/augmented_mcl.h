// SPDX-License-Identifier: Apache-2.0
// Augmented MCL (Probabilistic Robotics, table 8.3; paper section VI [12]): when the likelihood drops below its own
// long-term mean, the robot may have been carried away, and new particles are drawn.
#pragma once

#include "loc/localizer_config.h"
#include "platform/core/elementary.h"

namespace touchline {

class AugmentedMcl {
 public:
  /// `average` is the mean likelihood of the particles for this frame, >= 0.
  void update(float average, const AugmentedMclConfig& config) {
    slow_ = started_ ? slow_ + config.alpha_slow * (average - slow_) : average;
    fast_ = started_ ? fast_ + config.alpha_fast * (average - fast_) : average;
    started_ = true;
  }
  /// Share of particles to draw anew, in [random_share, 1].
  [[nodiscard]] float random_share(const AugmentedMclConfig& config) const {
    if (!started_ || slow_ <= 0.0F) return config.random_share;
    return math::clamp(1.0F - fast_ / slow_, config.random_share, 1.0F);
  }
  void reset() { *this = AugmentedMcl{}; }
  [[nodiscard]] float slow() const { return slow_; }
  [[nodiscard]] float fast() const { return fast_; }

 private:
  float slow_ = 0.0F;
  float fast_ = 0.0F;
  bool started_ = false;
};

}  // namespace touchline
