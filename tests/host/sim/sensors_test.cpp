// SPDX-License-Identifier: Apache-2.0
// The sensors err as much as their settings say, and no more.
#include "platform/host/sim/sensors.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace touchline;
using namespace touchline::sim;

namespace {

constexpr float dt = 1.0F / 12.0F;

WorldState walking() {
  WorldState s;
  s.step = {0.0167F, 0.0F, 0.02F};
  return s;
}

struct Spread {
  double sum = 0.0;
  double squares = 0.0;
  int n = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
    n += 1;
  }
  [[nodiscard]] double mean() const { return sum / n; }
  [[nodiscard]] double sigma() const { return std::sqrt(squares / n - mean() * mean()); }
};

}  // namespace

TEST_CASE("gait: bias and noise of the odometry") {
  GaitErrors errors;
  errors.seconds_between_slips = 0.0F;
  errors.drift = 0.0F;
  SimGait gait(errors, 1);
  Spread x;
  Spread y;
  Spread theta;
  for (int i = 0; i < 20000; ++i) {
    const Pose2 step = gait.step(walking(), dt);
    x.add(static_cast<double>(step.x));
    y.add(static_cast<double>(step.y));
    theta.add(static_cast<double>(step.theta));
  }
  const double root = std::sqrt(static_cast<double>(dt));
  CHECK(x.mean() == doctest::Approx(0.0167 * 1.06).epsilon(0.01));
  CHECK(theta.mean() == doctest::Approx(0.02 * 1.05).epsilon(0.02));
  CHECK(x.sigma() == doctest::Approx(0.011 * root).epsilon(0.05));
  CHECK(theta.sigma() == doctest::Approx(static_cast<double>(radians(1.4F)) * root).epsilon(0.05));
  CHECK(std::abs(y.mean()) < 1e-4);
}

TEST_CASE("gait: slips make the gait believe in more than happened; a fallen or kidnapped robot reports nothing") {
  GaitErrors errors;
  errors.noise_xy = 0.0F;
  errors.scale_x = 1.0F;
  errors.seconds_between_slips = 5.0F;
  SimGait gait(errors, 2);
  int slipping = 0;
  for (int i = 0; i < 12000; ++i) {
    const float x = gait.step(walking(), dt).x;
    const bool doubled = x > 0.03F;
    CHECK((doubled || x == doctest::Approx(0.0167F)));
    slipping += doubled ? 1 : 0;
  }
  CHECK(slipping == doctest::Approx(1200).epsilon(0.25));  // half a second of five
  WorldState down = walking();
  down.activity = Activity::fallen;
  CHECK(gait.step(down, dt).x == 0.0F);
  WorldState gone = walking();
  gone.kidnapped = true;
  CHECK(gait.step(gone, dt).theta == 0.0F);
}

TEST_CASE("imu: yaw drifts at its rate, stays continuous over full turns, and shows the goal's yaw") {
  ImuErrors errors;
  errors.noise = 0.0F;
  errors.wander = 0.0F;
  errors.drift = radians(0.1F);
  errors.goal_yaw = 0.5F;
  SimImu imu(errors, 3);
  WorldState s;
  for (int i = 0; i <= 720; ++i) {  // one minute, five turns
    s.pose.theta = wrap_angle(static_cast<float>(i) * math::two_pi * 5.0F / 720.0F);
    imu.step(s, dt);
  }
  CHECK(imu.yaw() == doctest::Approx(5.0F * math::two_pi + 0.5F + radians(6.0F)).epsilon(0.001));
}

TEST_CASE("imu: measured tilt is half a degree off, slowly") {
  SimImu imu(ImuErrors{}, 4);
  WorldState s;
  s.camera.pitch = 0.5F;
  Spread pitch;
  Spread change;
  float before = 0.0F;
  for (int i = 0; i < 40000; ++i) {
    imu.step(s, dt);
    const float error = imu.camera().pitch - 0.5F;
    pitch.add(static_cast<double>(error));
    if (i > 0) change.add(static_cast<double>(error - before));
    before = error;
  }
  const auto half_degree = static_cast<double>(radians(0.5F));
  CHECK(pitch.sigma() == doctest::Approx(half_degree).epsilon(0.06));
  CHECK(change.sigma() < 1.0 * half_degree);  // independent readings would give 1.41
  CHECK(std::abs(pitch.mean()) < 0.1 * half_degree);
}
