// SPDX-License-Identifier: Apache-2.0
// Every number of the localizer's configuration, of a prior and of an update's input, set to what no number may be.
#include <doctest/doctest.h>

#include <limits>
#include <memory>
#include <string_view>

#include "loc/localizer.h"
#include "loc/resampling.h"
#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float never[] = {nan, infinite, -infinite, 1e30F, -1e30F, -1.0F};

struct Key {
  std::string_view name;
  float& (*of)(LocalizerConfig& config);
};
using C = LocalizerConfig;
constexpr Key keys[] = {
    {"motion.xy_per_metre", [](C& c) -> float& { return c.motion.xy_per_metre; }},
    {"motion.xy_per_radian", [](C& c) -> float& { return c.motion.xy_per_radian; }},
    {"motion.theta_per_metre", [](C& c) -> float& { return c.motion.theta_per_metre; }},
    {"motion.theta_per_radian", [](C& c) -> float& { return c.motion.theta_per_radian; }},
    {"motion.xy_floor", [](C& c) -> float& { return c.motion.xy_floor; }},
    {"motion.theta_floor", [](C& c) -> float& { return c.motion.theta_floor; }},
    {"features.gamma", [](C& c) -> float& { return c.features.gamma; }},
    {"features.threshold", [](C& c) -> float& { return c.features.threshold; }},
    {"features.gate_m", [](C& c) -> float& { return c.features.gate_m; }},
    {"features.validation_gate_m", [](C& c) -> float& { return c.features.validation_gate_m; }},
    {"features.base_l", [](C& c) -> float& { return c.features.base_l; }},
    {"features.base_t", [](C& c) -> float& { return c.features.base_t; }},
    {"features.base_x", [](C& c) -> float& { return c.features.base_x; }},
    {"features.base_post", [](C& c) -> float& { return c.features.base_post; }},
    {"features.axis_half_angle", [](C& c) -> float& { return c.features.axis_half_angle; }},
    {"augmented.alpha_slow", [](C& c) -> float& { return c.augmented.alpha_slow; }},
    {"augmented.alpha_fast", [](C& c) -> float& { return c.augmented.alpha_fast; }},
    {"augmented.random_share", [](C& c) -> float& { return c.augmented.random_share; }},
    {"yaw_sigma", [](C& c) -> float& { return c.yaw_sigma; }},
    {"yaw_drift_rate", [](C& c) -> float& { return c.yaw_drift_rate; }},
    {"tilt_sigma", [](C& c) -> float& { return c.tilt_sigma; }},
    {"landmark_variance_floor", [](C& c) -> float& { return c.landmark_variance_floor; }},
    {"line_sigma_floor", [](C& c) -> float& { return c.line_sigma_floor; }},
    {"confident", [](C& c) -> float& { return c.confident; }},
};
// A new key needs its row above.
static_assert(sizeof(MotionNoise) == 6 * sizeof(float) && sizeof(FeatureManagerConfig) == 9 * sizeof(float));
static_assert(sizeof(AugmentedMclConfig) == 3 * sizeof(float));
static_assert(sizeof(LocalizerConfig) == 2 * sizeof(int) + (6 + 9 + 3 + 6) * sizeof(float) + sizeof(LocKernels));

struct Robot {
  Field field = test::field_of("acyut-5x3");
  test::SyntheticView view{field, test::paper_lens(), 752, 480};
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};
  std::unique_ptr<Localizer> localizer = std::make_unique<Localizer>();
  PoseEstimate estimate;
  Rng rng{5};

  Robot() {
    REQUIRE(localizer->configure({}, field) == Status::ok);
    REQUIRE(localizer->reset({}, 3) == Status::ok);
  }
  Status update(const LocalizerInput& input, const Pose2& truth = {}) {
    return localizer->update(input, view.look(truth, camera, {}, rng), estimate);
  }
};

}  // namespace

TEST_CASE("every number of the configuration is checked, and the refused key is named") {
  Robot robot;
  for (const Key& key : keys) {
    for (const float value : never) {
      CAPTURE(key.name);
      CAPTURE(value);
      LocalizerConfig config;
      key.of(config) = value;
      const char* what = "";
      CHECK(robot.localizer->configure(config, robot.field, &what) == Status::invalid_argument);
      CHECK(std::string_view(what) == key.name);
    }
  }
  LocalizerConfig config;
  config.model = static_cast<LocModel>(7);
  CHECK(robot.localizer->configure(config, robot.field) == Status::invalid_argument);
  config = {};
  config.landmarks = static_cast<Landmarks>(7);
  CHECK(robot.localizer->configure(config, robot.field) == Status::invalid_argument);
  CHECK(robot.localizer->configure({}, robot.field) == Status::ok);
}

TEST_CASE("a prior that is no place is refused, and nothing changes") {
  Robot robot;
  const float before = robot.localizer->particles().x[7];
  using P = Prior;
  float& (*const numbers[])(P&) = {[](P& p) -> float& { return p.pose.x; }, [](P& p) -> float& { return p.pose.y; },
                                   [](P& p) -> float& { return p.pose.theta; },
                                   [](P& p) -> float& { return p.sigma_xy; },
                                   [](P& p) -> float& { return p.sigma_theta; }};
  for (const auto& number : numbers) {
    for (const float value : {nan, infinite, -infinite, 1e30F}) {
      Prior prior;
      prior.kind = PriorKind::pose;
      number(prior) = value;
      CHECK(robot.localizer->reset(prior, 9) == Status::invalid_argument);
    }
  }
  Prior prior;
  prior.sigma_xy = -0.1F;
  CHECK(robot.localizer->reset(prior, 9) == Status::invalid_argument);
  prior = {};
  prior.kind = static_cast<PriorKind>(9);
  CHECK(robot.localizer->reset(prior, 9) == Status::invalid_argument);
  CHECK(robot.localizer->particles().x[7] == before);
}

TEST_CASE("every number of an update is checked, and nothing changes") {
  Robot robot;
  using I = LocalizerInput;
  float& (*const numbers[])(I&) = {
      [](I& i) -> float& { return i.odometry.x; },     [](I& i) -> float& { return i.odometry.y; },
      [](I& i) -> float& { return i.odometry.theta; }, [](I& i) -> float& { return i.unknown_xy; },
      [](I& i) -> float& { return i.unknown_theta; },  [](I& i) -> float& { return i.yaw; }};
  const float before = robot.localizer->particles().x[7];
  for (const auto& number : numbers) {
    for (const float value : {nan, infinite, -infinite, 1e30F}) {
      LocalizerInput input;
      input.has_yaw = true;
      number(input) = value;
      CHECK(robot.update(input) == Status::invalid_argument);
    }
  }
  LocalizerInput input;
  input.unknown_xy = -0.1F;
  CHECK(robot.update(input) == Status::invalid_argument);
  input = {};
  input.odometry.y = 101.0F;
  CHECK(robot.update(input) == Status::invalid_argument);
  CHECK(robot.localizer->particles().x[7] == before);
}

TEST_CASE("a pose that odometry carries far off the field is none, and the next frames find the robot again") {
  for (const LocModel model : {LocModel::full, LocModel::paper}) {
    Robot robot;
    LocalizerConfig config;
    config.model = model;
    REQUIRE(robot.localizer->configure(config, robot.field) == Status::ok);
    LocalizerInput input;
    input.has_yaw = true;
    for (int i = 0; i < 20; ++i) REQUIRE(robot.update(input) == Status::ok);
    REQUIRE(robot.estimate.valid);
    input.odometry.x = max_step_m;
    const VisionResult nothing;
    Features none;
    VisionResult blind = nothing;
    blind.features = &none;
    for (int i = 0; i < 5; ++i) {
      REQUIRE(robot.localizer->update(input, blind, robot.estimate) == Status::ok);
      CHECK_FALSE(robot.estimate.valid);
      CHECK_FALSE(robot.estimate.settled);
    }
    input.odometry = {};
    for (int i = 0; i < 80; ++i) REQUIRE(robot.update(input) == Status::ok);
    REQUIRE(robot.estimate.valid);
    CHECK(math::hypot(robot.estimate.pose.x, robot.estimate.pose.y) < 1.0F);
  }
}

TEST_CASE("weights and shares that are no number spoil nothing else") {
  ParticleStorage<4> cloud;
  ResamplingStorage<4> work;
  for (std::size_t i = 0; i < 4; ++i) cloud.x[i] = static_cast<float>(i);
  cloud.log_weight = {nan, infinite, 0.0F, -100.0F};
  Rng rng(1);
  resample_low_variance(cloud.view(4), 4, work.memory(), rng);
  for (const float x : cloud.x) CHECK(x == 2.0F);
  CHECK(part_of(200, nan) == 0);
  CHECK(part_of(200, -1.0F) == 0);
  CHECK(part_of(200, 0.25F) == 50);
  CHECK(part_of(200, 1e30F) == 200);
}
