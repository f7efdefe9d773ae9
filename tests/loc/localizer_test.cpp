// SPDX-License-Identifier: Apache-2.0
// The localizer on perfect and on spoiled synthetic views: start from nothing, tracking, kidnap, mirror, errors.
#include "loc/localizer.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {

float distance(const Pose2& a, const Pose2& b) { return math::hypot(a.x - b.x, a.y - b.y); }

struct Robot {
  Field field;
  test::SyntheticView view;
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};
  std::unique_ptr<Localizer> localizer = std::make_unique<Localizer>();
  LocalizerConfig config;
  test::SyntheticOptions options;
  PoseEstimate estimate;
  Pose2 truth;
  double time_s = 0.0;
  bool has_yaw = true;
  Rng rng{31};

  explicit Robot(const char* preset = "acyut-5x3")
      : field(test::field_of(preset)), view(field, test::paper_lens(), 752, 480) {
    options.pixel_noise = 1.0F;
    start();
  }
  void start(const Prior& prior = {}) {
    REQUIRE(localizer->configure(config, field) == Status::ok);
    REQUIRE(localizer->reset(prior, 77) == Status::ok);
  }
  void frame(const Pose2& step = {}, float yaw_error = 0.0F) {
    truth = compose(truth, step);
    time_s += 1.0 / 12.0;
    LocalizerInput input;
    input.time_s = time_s;
    input.odometry = step;
    input.has_yaw = has_yaw;
    input.yaw = wrap_angle(truth.theta + yaw_error);
    REQUIRE(localizer->update(input, view.look(truth, camera, options, rng), estimate) == Status::ok);
  }
};

}  // namespace

TEST_CASE("from nothing, with yaw, the pose is there within a few frames, and settles") {
  Robot robot;
  int settled = 0;
  for (int i = 0; i < 20; ++i) {
    robot.start();
    robot.truth = {robot.rng.uniform(-2.2F, 2.2F), robot.rng.uniform(-1.3F, 1.3F), robot.rng.uniform(-3.1F, 3.1F)};
    robot.estimate = {};
    for (int k = 0; k < 12 && !robot.estimate.settled; ++k) robot.frame();
    CAPTURE(robot.truth.x);
    CAPTURE(robot.truth.y);
    CAPTURE(robot.truth.theta);
    REQUIRE(robot.estimate.valid);
    if (robot.estimate.settled) {
      ++settled;
      CHECK(distance(robot.estimate.pose, robot.truth) < 0.05F);
    }
  }
  CHECK(settled >= 17);
}

TEST_CASE("without yaw the mirrored pose is kept and reported") {
  Robot robot;
  robot.has_yaw = false;
  robot.truth = {-1.0F, 0.5F, 0.3F};
  for (int i = 0; i < 6; ++i) robot.frame();
  REQUIRE(robot.estimate.valid);
  REQUIRE(robot.estimate.has_mirror);
  const bool right = distance(robot.estimate.pose, robot.truth) < 0.1F;
  const Pose2& twin = right ? robot.estimate.mirror : robot.estimate.pose;
  const Pose2& pose = right ? robot.estimate.pose : robot.estimate.mirror;
  CHECK(distance(pose, robot.truth) < 0.1F);
  CHECK(distance(twin, mirrored(robot.truth)) < 0.1F);
}

TEST_CASE("a kick-off prior in the own half decides the half without a yaw") {
  Robot robot;
  robot.has_yaw = false;
  robot.truth = {-1.0F, 0.5F, 0.3F};
  Prior prior;
  prior.kind = PriorKind::pose;
  prior.pose = {-1.2F, 0.3F, 0.2F};
  robot.start(prior);
  for (int i = 0; i < 10; ++i) robot.frame();
  CHECK(distance(robot.estimate.pose, robot.truth) < 0.05F);
}

TEST_CASE("a walk is tracked with noisy attitude, and the covariance covers the error") {
  Robot robot;
  robot.truth = {-1.5F, -0.5F, 0.5F};
  double squares = 0.0;
  int outside = 0;
  for (int i = 0; i < 120; ++i) {
    robot.options.pitch_error = radians(0.5F) * robot.rng.gaussian();
    robot.options.roll_error = radians(0.5F) * robot.rng.gaussian();
    robot.frame({0.015F, 0.0F, radians(1.0F)});
    if (i < 12) continue;
    const float e = distance(robot.estimate.pose, robot.truth);
    squares += static_cast<double>(e * e);
    if (e * e > 9.0F * (robot.estimate.covariance.xx + robot.estimate.covariance.yy)) ++outside;
  }
  CHECK(std::sqrt(squares / 108.0) < 0.03);
  CHECK(outside <= 3);
}

TEST_CASE("after an unannounced kidnap the pose is back within a second") {
  Robot robot;
  robot.truth = {-1.5F, -0.5F, 0.5F};
  for (int i = 0; i < 24; ++i) robot.frame();
  REQUIRE(distance(robot.estimate.pose, robot.truth) < 0.05F);
  robot.truth = {1.2F, 0.8F, -2.0F};
  int back = 0;
  for (; back < 24; ++back) {
    robot.frame();
    if (distance(robot.estimate.pose, robot.truth) < 0.2F) break;
  }
  CHECK(back < 12);
}

TEST_CASE("a drift of the yaw neither turns the pose nor picks the wrong half") {
  Robot robot;
  robot.truth = {-1.0F, 0.3F, 0.4F};
  float drift = 0.0F;
  for (int i = 0; i < 12 * 180; ++i) {
    drift += radians(12.0F) / (12.0F * 60.0F);  // 12 degrees in a minute, a poor IMU
    robot.frame({}, drift);
  }
  CHECK(distance(robot.estimate.pose, robot.truth) < 0.05F);
  CHECK(math::abs(angle_difference(robot.estimate.yaw_drift, drift)) < radians(5.0F));
}

TEST_CASE("blind frames: the pose goes on by odometry and its uncertainty grows") {
  Robot robot;
  robot.truth = {-1.0F, 0.3F, 0.4F};
  for (int i = 0; i < 12; ++i) robot.frame();
  const float before = robot.estimate.covariance.xx;
  robot.options.covered = true;
  for (int i = 0; i < 10; ++i) robot.frame({0.02F, 0.0F, 0.0F});
  REQUIRE(robot.estimate.valid);
  CHECK(distance(robot.estimate.pose, robot.truth) < 0.1F);
  CHECK(robot.estimate.covariance.xx > 1.5F * before);
}

TEST_CASE("nothing ever seen: no pose, no error") {
  Robot robot;
  robot.options.covered = true;
  robot.frame();
  CHECK_FALSE(robot.estimate.valid);
}

TEST_CASE("paper mode finds a pose from junctions alone in a second of frames") {
  Robot robot;
  robot.config.model = LocModel::paper;
  int good = 0;
  for (int i = 0; i < 10; ++i) {
    robot.start();
    robot.truth = {robot.rng.uniform(-1.5F, 1.5F), robot.rng.uniform(-1.0F, 1.0F), robot.rng.uniform(-3.1F, 3.1F)};
    for (int k = 0; k < 48; ++k) robot.frame();
    if (distance(robot.estimate.pose, robot.truth) < 0.4F) ++good;
  }
  CHECK(good >= 8);
}

TEST_CASE("the same seed gives the same poses, another seed others") {
  Robot a;
  Robot b;
  a.truth = b.truth = {0.5F, -0.4F, 1.0F};
  for (int i = 0; i < 5; ++i) {
    a.frame();
    b.frame();
  }
  CHECK(a.estimate.pose.x == b.estimate.pose.x);
  CHECK(a.localizer->particles().x[100] == b.localizer->particles().x[100]);
  (void)b.localizer->reset({}, 78);
  CHECK(a.localizer->particles().x[100] != b.localizer->particles().x[100]);
}

TEST_CASE("bad input is refused and changes nothing") {
  Localizer fresh;
  PoseEstimate estimate;
  Robot robot;
  const VisionResult& vision = robot.view.look({}, robot.camera, {}, robot.rng);
  CHECK(fresh.update({}, vision, estimate) == Status::not_ready);
  CHECK(fresh.reset({}, 1) == Status::not_ready);
  LocalizerInput input;
  input.odometry.x = std::numeric_limits<float>::quiet_NaN();
  CHECK(robot.localizer->update(input, vision, estimate) == Status::invalid_argument);
  input = {};
  input.has_yaw = true;
  input.yaw = std::numeric_limits<float>::infinity();
  CHECK(robot.localizer->update(input, vision, estimate) == Status::invalid_argument);
  LocalizerConfig config;
  config.particles = 5000;
  const char* what = nullptr;
  CHECK(robot.localizer->configure(config, robot.field, &what) == Status::invalid_argument);
  CHECK(std::string_view(what) == "particles");
}
