// SPDX-License-Identifier: Apache-2.0
#include "loc/feature_manager.h"

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

  Fixture() {
    vision.projection = GroundProjection(test::paper_lens(), {0, 0, 0.6F, 0, 0.5F, 0});
    vision.features = features.get();
  }
  void see(JunctionType type, GroundPoint at) {
    Junction j;
    j.type = type;
    j.ground = at;
    j.confidence = 1.0F;
    REQUIRE(vision.projection.pixel(at, j.pixel));
    features->junctions.push_back(j);
  }
  void frame(const Pose2& step = {}, const Pose2* pose = nullptr) {
    manager.update(step, vision, Landmarks::lines, field, pose, config);
  }
};
}  // namespace

TEST_CASE("eq. (1): confidence starts at 1, decays by exp(-1/gamma) a frame, and grows by 1 with every sighting") {
  Fixture f;
  f.see(JunctionType::t, {1.0F, 0.2F});
  f.frame();
  const FeatureList& list = f.manager.list(FeatureType::t);
  REQUIRE(list.size() == 1);
  CHECK(list[0].confidence == 1.0F);
  f.frame();
  CHECK(list[0].confidence == doctest::Approx(std::exp(-1.0 / 50.0) + 1.0));
  f.features->junctions.clear();
  for (int i = 0; i < 10; ++i) f.frame();
  CHECK(list[0].confidence == doctest::Approx((std::exp(-1.0 / 50.0) + 1.0) * std::exp(-10.0 / 50.0)));
}

TEST_CASE("confidence saturates at about gamma, and a feature no longer seen is forgotten below the threshold") {
  Fixture f;
  f.see(JunctionType::x, {1.0F, 0.0F});
  for (int i = 0; i < 1000; ++i) f.frame();
  const FeatureList& list = f.manager.list(FeatureType::x);
  CHECK(list[0].confidence == doctest::Approx(static_cast<double>(FeatureManager::saturation(f.config))).epsilon(1e-3));
  f.features->junctions.clear();
  for (int i = 0; i < 260 && !list.empty(); ++i) f.frame();
  CHECK(list.empty());
}

TEST_CASE("a remembered feature moves with the odometry and is met again there") {
  Fixture f;
  f.see(JunctionType::l, {1.0F, 0.0F});
  f.frame();
  f.features->junctions.clear();
  f.frame({0.2F, 0.0F, math::half_pi});
  const FeatureList& list = f.manager.list(FeatureType::l);
  CHECK(list[0].ground.x == doctest::Approx(0.0).epsilon(1e-4));
  CHECK(list[0].ground.y == doctest::Approx(-0.8));
  f.see(JunctionType::l, {0.1F, -0.8F});
  f.frame();
  CHECK(list.size() == 1);
  CHECK(list[0].confidence > 1.5F);
}

TEST_CASE("other types and places beyond the gate are other features") {
  Fixture f;
  f.see(JunctionType::l, {1.0F, 0.0F});
  f.frame();
  f.features->junctions.clear();
  f.see(JunctionType::t, {1.0F, 0.0F});
  f.see(JunctionType::l, {1.0F, 0.5F});
  f.frame();
  CHECK(f.manager.list(FeatureType::l).size() == 2);
  CHECK(f.manager.list(FeatureType::t).size() == 1);
}

TEST_CASE("a sure pose turns down what the field does not have there; without a pose nothing is turned down") {
  Fixture f;
  f.see(JunctionType::x, {1.0F, 0.0F});  // small-2026 has its X's at (0, +-0.75)
  f.frame();
  CHECK(f.manager.counts().turned_down == 0);
  f.manager.clear();
  const Pose2 far_away{3.0F, 2.0F, 0.0F};
  f.frame({}, &far_away);
  CHECK(f.manager.counts().turned_down == 1);
  CHECK(f.manager.list(FeatureType::x).empty());
  const Pose2 right{-1.0F, 0.75F, 0.0F};
  f.frame({}, &right);
  CHECK(f.manager.counts().turned_down == 0);
}

TEST_CASE("the base likelihood falls with the distance from the polar axis") {
  Fixture f;
  f.see(JunctionType::t, {1.0F, 0.0F});
  f.see(JunctionType::t, {0.3F, 1.5F});
  f.frame();
  const FeatureList& list = f.manager.list(FeatureType::t);
  REQUIRE(list.size() == 2);
  CHECK(list[0].base > list[1].base + 0.1F);
}

TEST_CASE("a full list counts what it drops") {
  Fixture f;
  for (int i = 0; i < 32; ++i)
    f.see(JunctionType::l, {0.4F + 0.1F * static_cast<float>(i % 8), static_cast<float>(i / 8) - 2.0F});
  f.config.gate_m = 0.01F;
  f.frame();
  for (Junction& j : f.features->junctions.span()) j.ground.y += 0.05F;
  f.frame();
  CHECK(f.manager.list(FeatureType::l).full());
  CHECK(f.manager.counts().dropped == 32);
}
