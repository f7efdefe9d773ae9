// SPDX-License-Identifier: Apache-2.0
#include "loc/yaw_tracker.h"

#include <doctest/doctest.h>

#include "platform/core/rng.h"

using namespace touchline;

TEST_CASE("a slow drift is followed for ten minutes, beyond a right angle") {
  YawTracker tracker;
  Rng rng(3);
  const float rate = radians(12.0F) / 60.0F;  // 12 degrees a minute, a poor IMU
  const float dt = 1.0F / 12.0F;
  float drift = 0.0F;
  for (int i = 0; i < 12 * 600; ++i) {
    drift += rate * dt;
    const float theta = 0.3F;
    tracker.predict(dt, radians(0.5F));
    tracker.correct(wrap_angle(theta + drift + radians(1.0F) * rng.gaussian()), theta, 1e-4F, radians(3.0F));
  }
  CHECK(math::abs(angle_difference(tracker.drift(), drift)) < radians(2.0F));
}

TEST_CASE("a yaw that jumps is no drift") {
  YawTracker tracker;
  tracker.predict(1.0F, radians(0.1F));
  tracker.correct(math::pi, 0.0F, 1e-4F, radians(3.0F));
  CHECK(tracker.drift() == 0.0F);
}

TEST_CASE("uncertainty of the drift widens the evidence while nothing corrects it") {
  YawTracker tracker;
  const float before = tracker.evidence(0.0F, radians(3.0F)).sigma;
  tracker.predict(100.0F, radians(0.5F));
  CHECK(tracker.evidence(0.0F, radians(3.0F)).sigma > before + radians(1.0F));
}
