// SPDX-License-Identifier: Apache-2.0
#include "loc/resampling.h"

#include <doctest/doctest.h>

#include <cmath>

using namespace touchline;

namespace {
struct Fixture {
  ParticleStorage<100> storage;
  ResamplingStorage<100> work;
  ParticleView p = storage.view(100);
  Fixture() {
    for (int i = 0; i < 100; ++i) p.set_pose(i, {static_cast<float>(i), 0.0F, 0.0F});
  }
};
}  // namespace

TEST_CASE("equal weights: low-variance resampling keeps every particle once") {
  Fixture f;
  for (int i = 0; i < 100; ++i) f.p.log_weight[i] = -1234.5F;  // only differences count
  CHECK(effective_count(f.p) == doctest::Approx(100.0));
  Rng rng(7);
  resample_low_variance(f.p, 100, f.work.memory(), rng);
  for (int i = 0; i < 100; ++i) CHECK(f.p.x[i] == static_cast<float>(i));
}

TEST_CASE("a particle of weight w is drawn floor or ceil of w times n") {
  Fixture f;
  double total = 0.0;
  for (int i = 0; i < 100; ++i) {
    f.p.log_weight[i] = -0.05F * static_cast<float>(i);
    total += std::exp(-0.05 * i);
  }
  Rng rng(8);
  resample_low_variance(f.p, 100, f.work.memory(), rng);
  int counts[100] = {};
  for (int i = 0; i < 100; ++i) ++counts[static_cast<int>(f.p.x[i])];
  for (int i = 0; i < 100; ++i) {
    const double expected = 100.0 * std::exp(-0.05 * i) / total;
    CHECK(counts[i] >= std::floor(expected - 1e-3));
    CHECK(counts[i] <= std::ceil(expected + 1e-3));
  }
}

TEST_CASE("copies move up and down the places, and none is lost on the way") {
  // Heavy in the first third: its copies move up; light in the second: what comes behind moves down.
  const auto log_weight = [](int i) { return i < 33 ? 0.5F : i < 66 ? -3.0F : 0.2F * static_cast<float>(i % 7); };
  Fixture f;
  double total = 0.0;
  for (int i = 0; i < 100; ++i) {
    f.p.log_weight[i] = log_weight(i);
    total += std::exp(static_cast<double>(log_weight(i)));
  }
  Rng rng(11);
  resample_low_variance(f.p, 100, f.work.memory(), rng);
  int counts[100] = {};
  int up = 0, down = 0;
  for (int i = 0; i < 100; ++i) {
    const int from = static_cast<int>(f.p.x[i]);
    ++counts[from];
    up += from < i ? 1 : 0;
    down += from > i ? 1 : 0;
    if (i > 0) CHECK(f.p.x[i] >= f.p.x[i - 1]);
  }
  CHECK(up > 0);
  CHECK(down > 0);
  for (int i = 0; i < 100; ++i) {
    const double expected = 100.0 * std::exp(static_cast<double>(log_weight(i))) / total;
    CHECK(counts[i] >= std::floor(expected - 1e-3));
    CHECK(counts[i] <= std::ceil(expected + 1e-3));
  }
}

TEST_CASE("one particle with all the weight takes every place kept, the rest stay the caller's") {
  Fixture f;
  for (int i = 0; i < 100; ++i) f.p.log_weight[i] = i == 42 ? 0.0F : -200.0F;
  CHECK(effective_count(f.p) == doctest::Approx(1.0));
  Rng rng(9);
  resample_low_variance(f.p, 60, f.work.memory(), rng);
  for (int i = 0; i < 60; ++i) CHECK(f.p.x[i] == 42.0F);
  CHECK(f.p.x[60] == 60.0F);
}

TEST_CASE("roughening spreads copies by a share of the cloud's extent, and a cloud in one point stays there") {
  Fixture f;
  for (int i = 0; i < 100; ++i) f.p.set_pose(i, {i < 50 ? 0.0F : 10.0F, 1.0F, 0.0F});
  Rng rng(10);
  roughen(f.p, 0.2F, rng);
  double squares = 0.0;
  for (int i = 0; i < 100; ++i) {
    const double e = static_cast<double>(f.p.x[i] - (i < 50 ? 0.0F : 10.0F));
    squares += e * e;
    CHECK(f.p.y[i] == 1.0F);
  }
  CHECK(std::sqrt(squares / 100) == doctest::Approx(0.2 * 10.0 / std::cbrt(100.0)).epsilon(0.25));
}
