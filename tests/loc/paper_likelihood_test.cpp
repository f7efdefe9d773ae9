// SPDX-License-Identifier: Apache-2.0
#include "loc/paper_likelihood.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>

#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {
struct Fixture {
  Field field = test::field_of("small-2026");
  std::unique_ptr<Features> features = std::make_unique<Features>();
  VisionResult vision;
  FeatureManager manager;
  FeatureManagerConfig config;
  ParticleStorage<3> storage;
  ParticleView p = storage.view(3);

  Fixture() {
    vision.projection = GroundProjection(test::paper_lens(), {0, 0, 0.6F, 0, 0.5F, 0});
    vision.features = features.get();
    Junction j;
    j.type = JunctionType::x;
    j.ground = {1.0F, 0.0F};
    j.confidence = 1.0F;
    REQUIRE(vision.projection.pixel(j.ground, j.pixel));
    features->junctions.push_back(j);
    manager.update({}, vision, Landmarks::lines, field, nullptr, config);
  }
};
}  // namespace

TEST_CASE("eq. (5) by hand: minus the distance over twice the variance, weighed by confidence") {
  Fixture f;
  // One X at displacement (1, 0). From (-1, 0.75, 0) the X at (0, 0.75) is exactly there.
  f.p.set_pose(0, {-1.0F, 0.75F, 0.0F});
  f.p.set_pose(1, {-1.2F, 0.75F, 0.0F});
  f.p.set_pose(2, {-1.0F, 1.05F, 0.0F});
  const float floor = 100.0F;  // larger than any variance here, so that it is the variance
  add_paper_likelihood(f.field, f.manager, f.config, floor, 0, false, f.p);
  const TrackedFeature& x = f.manager.list(FeatureType::x)[0];
  const double weight = static_cast<double>(x.base * x.confidence / FeatureManager::saturation(f.config));
  CHECK(f.p.log_weight[0] == doctest::Approx(0.0).epsilon(1e-6));
  CHECK(f.p.log_weight[1] == doctest::Approx(-weight * 0.2 / 200.0).epsilon(1e-3));
  CHECK(f.p.log_weight[2] == doctest::Approx(-weight * 0.3 / 200.0).epsilon(1e-3));
}

TEST_CASE("the variance is that of the particles' distances to the landmark, but never below the floor") {
  Fixture f;
  f.p.set_pose(0, {-1.0F, 0.75F, 0.0F});
  f.p.set_pose(1, {-2.0F, 0.75F, 0.0F});
  f.p.set_pose(2, {-3.0F, 0.75F, 0.0F});  // distances 1, 2, 3 to (0, 0.75): variance 2/3
  add_paper_likelihood(f.field, f.manager, f.config, 1e-3F, 0, false, f.p);
  const TrackedFeature& x = f.manager.list(FeatureType::x)[0];
  const double weight = static_cast<double>(x.base * x.confidence / FeatureManager::saturation(f.config));
  CHECK(f.p.log_weight[1] == doctest::Approx(-weight * 1.0 / (2.0 * 2.0 / 3.0)).epsilon(1e-3));
}

TEST_CASE("with ranges alone the heading does not enter") {
  Fixture f;
  for (int i = 0; i < 3; ++i) f.p.set_pose(i, {-1.0F, 0.75F, static_cast<float>(i)});
  add_paper_likelihood(f.field, f.manager, f.config, 0.05F, 0, true, f.p);
  CHECK(f.p.log_weight[1] == doctest::Approx(static_cast<double>(f.p.log_weight[0])).epsilon(1e-5));
  for (int i = 0; i < 3; ++i) f.p.log_weight[i] = 0.0F;
  add_paper_likelihood(f.field, f.manager, f.config, 0.05F, 0, false, f.p);
  CHECK(f.p.log_weight[1] < f.p.log_weight[0] - 0.01F);
}
