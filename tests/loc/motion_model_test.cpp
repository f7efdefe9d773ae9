// SPDX-License-Identifier: Apache-2.0
#include "loc/motion_model.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace touchline;

TEST_CASE("a step without noise moves every particle in its own frame") {
  ParticleStorage<2> storage;
  const ParticleView p = storage.view(2);
  p.set_pose(0, {0.0F, 0.0F, 0.0F});
  p.set_pose(1, {1.0F, 1.0F, math::half_pi});
  const MotionNoise none{0, 0, 0, 0, 0, 0};
  Rng rng(1);
  move_particles(p, {0.5F, 0.0F, 0.1F}, none, portable_loc_kernels(), rng);
  CHECK(p.x[0] == doctest::Approx(0.5));
  CHECK(p.y[1] == doctest::Approx(1.5));
  CHECK(p.theta[1] == doctest::Approx(math::half_pi + 0.1F));
}

TEST_CASE("the cloud spreads as the noise says") {
  ParticleStorage<1000> storage;
  const ParticleView p = storage.view(1000);
  MotionNoise noise;
  noise.xy_per_metre = 0.2F;
  Rng rng(2);
  const Pose2 step{0.5F, 0.0F, 0.2F};
  move_particles(p, step, noise, portable_loc_kernels(), rng);
  const StepSigma sigma = step_sigma(step, noise);
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double e = static_cast<double>(p.x[i]) - 0.5;
    sum += e;
    squares += e * e;
  }
  CHECK(sum / 1000 == doctest::Approx(0.0).epsilon(0.02));
  CHECK(std::sqrt(squares / 1000) == doctest::Approx(static_cast<double>(sigma.x)).epsilon(0.1));
}

TEST_CASE("each kind of motion brings its own kind of noise") {
  const MotionNoise noise;
  CHECK(step_sigma({0.1F, 0, 0}, noise).x > step_sigma({0, 0.1F, 0}, noise).x);
  CHECK(step_sigma({0, 0.1F, 0}, noise).y > step_sigma({0.1F, 0, 0}, noise).y);
  CHECK(step_sigma({0, 0, 0.1F}, noise).theta > step_sigma({0, 0, 0}, noise).theta);
  CHECK(step_sigma({0, 0, 0}, noise).x > 0.0F);
}
