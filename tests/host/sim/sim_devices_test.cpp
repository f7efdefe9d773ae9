// SPDX-License-Identifier: Apache-2.0
// The simulated robot keeps the contracts of hal's interfaces.
#include "platform/host/sim/sim_devices.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "platform/core/hash.h"
#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

/// A walk with pictures of 64 x 48 pixels.
WalkScenarioOptions tiny_walk() {
  SimCameraModel camera = *camera_model("fisheye-140");
  camera.width = 64;
  camera.height = 48;
  camera.lens.cx = 32.0F;
  camera.lens.cy = 24.0F;
  camera.lens.focal_px *= 0.1F;
  return acceptance_walk(small_field(), camera, 9);
}

constexpr MonotonicNs later = 100 * one_second;

}  // namespace

TEST_CASE("devices: nothing works before open, and opening twice is one opening") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 1.0);
  CHECK(robot->camera().acquire(later).status() == Status::disconnected);
  CHECK(robot->imu().read().status() == Status::disconnected);
  CHECK(robot->gait().read().status() == Status::disconnected);
  CHECK(robot->panel().poll(0).status() == Status::disconnected);
  CHECK(robot->camera().open() == Status::ok);
  CHECK(robot->camera().open() == Status::ok);
  CHECK(robot->camera().health().opened == 1);
}

TEST_CASE("devices: frames come at their rate, readings with them, until the data ends") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 1.0);
  REQUIRE(robot->camera().open() == Status::ok);
  REQUIRE(robot->imu().open() == Status::ok);
  REQUIRE(robot->gait().open() == Status::ok);
  int frames = 0;
  int readings = 0;
  MonotonicNs last = 0;
  Pose2 odometry;
  for (;;) {
    const Result<CameraFrame> frame = robot->camera().acquire(later);
    if (frame.status() == Status::end_of_data) break;
    REQUIRE(frame.ok());
    CHECK(frame.value().time > last);
    CHECK(robot->clock().now() == frame.value().time);
    last = frame.value().time;
    odometry = compose(odometry, robot->truth().odometry);
    for (Result<ImuSample> imu = robot->imu().read(); imu.ok(); imu = robot->imu().read()) {
      CHECK(imu.value().time <= last);
      readings += 1;
    }
    GaitSample newest;
    for (Result<GaitSample> gait = robot->gait().read(); gait.ok(); gait = robot->gait().read()) newest = gait.value();
    CHECK(newest.odometry.x == doctest::Approx(odometry.x));
    CHECK(newest.odometry.theta == doctest::Approx(odometry.theta));
    CHECK(newest.camera_pitch == robot->truth().mount.pitch);
    REQUIRE(robot->camera().release(frame.value()) == Status::ok);
    frames += 1;
  }
  CHECK(frames == 13);  // both ends of a second at 12 frames a second
  CHECK(readings == 1 + 12 * 4);
}

TEST_CASE("devices: waiting for too short a time is a timeout and costs that time") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 1.0);
  REQUIRE(robot->camera().open() == Status::ok);
  REQUIRE(robot->camera().acquire(later).ok());
  const MonotonicNs now = robot->clock().now();
  CHECK(robot->camera().acquire(now + 10 * one_millisecond).status() == Status::timeout);
  CHECK(robot->clock().now() == now + 10 * one_millisecond);
  CHECK(robot->camera().acquire(now + 100 * one_millisecond).ok());
}

TEST_CASE("devices: a kidnap takes time, in which no frame comes, the IMU feels the turn and the gait no step") {
  WalkScenarioOptions options = tiny_walk();
  options.yaw = true;
  options.kidnap_at_s = 0.5;
  auto robot = std::make_unique<SimRobot>(options, 1.0);
  REQUIRE(robot->camera().open() == Status::ok);
  REQUIRE(robot->imu().open() == Status::ok);
  REQUIRE(robot->gait().open() == Status::ok);
  MonotonicNs before = 0;
  bool seen = false;
  float largest_turn = 0.0F;
  float yaw = 0.0F;
  bool has_yaw = false;
  while (true) {
    const Result<CameraFrame> frame = robot->camera().acquire(robot->clock().now() + 20 * one_millisecond);
    if (frame.status() == Status::end_of_data) break;
    for (auto imu = robot->imu().read(); imu.ok(); imu = robot->imu().read()) {
      CHECK(imu.value().time <= robot->clock().now());  // nothing is told before it happens
      if (has_yaw) largest_turn = std::max(largest_turn, std::abs(imu.value().yaw - yaw));
      yaw = imu.value().yaw;
      has_yaw = true;
    }
    for (auto gait = robot->gait().read(); gait.ok(); gait = robot->gait().read()) CHECK_FALSE(gait.value().lifted);
    if (!frame.ok()) continue;
    const MonotonicNs gap = frame.value().time - before;
    if (robot->truth().kidnapped) {
      seen = true;
      CHECK(gap > 600 * one_millisecond);
    } else if (before != 0) {
      CHECK(gap < 100 * one_millisecond);
    }
    before = frame.value().time;
    REQUIRE(robot->camera().release(frame.value()) == Status::ok);
  }
  CHECK(seen);
  CHECK(largest_turn < radians(10.0F));  // half a turn in 30 readings, and noise
}

TEST_CASE("devices: four buffers are lent at the most, and only what is lent can be given back") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 2.0);
  REQUIRE(robot->camera().open() == Status::ok);
  Result<CameraFrame> first = robot->camera().acquire(later);
  const std::uint64_t hash = hash_bytes(first.value().image.data, 64 * 48 * 3);
  for (int i = 0; i < 3; ++i) REQUIRE(robot->camera().acquire(later).ok());
  CHECK(robot->camera().acquire(later).status() == Status::capacity);
  CHECK(hash_bytes(first.value().image.data, 64 * 48 * 3) == hash);  // a lent frame does not change
  CHECK(robot->camera().release(first.value()) == Status::ok);
  CHECK(robot->camera().release(first.value()) == Status::invalid_argument);
  CHECK(robot->camera().acquire(later).ok());
}

TEST_CASE("devices: another pixel format carries the same walk") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 1.0, PixelFormat::yuyv);
  REQUIRE(robot->camera().open() == Status::ok);
  const Result<CameraFrame> frame = robot->camera().acquire(later);
  REQUIRE(frame.ok());
  CHECK(frame.value().image.format == PixelFormat::yuyv);
  CHECK(frame.value().image.stride_bytes == 128);
}

TEST_CASE("devices: presses wait for their time; the light shows what it was told") {
  auto robot = std::make_unique<SimRobot>(tiny_walk(), 1.0);
  REQUIRE(robot->panel().open() == Status::ok);
  robot->panel().push({2 * one_second, ButtonPress::long_press});
  CHECK(robot->panel().poll(one_second).status() == Status::not_ready);
  const Result<ButtonEvent> press = robot->panel().poll(2 * one_second);
  REQUIRE(press.ok());
  CHECK(press.value().press == ButtonPress::long_press);
  robot->panel().show(LedPattern::sure);
  CHECK(robot->panel().pattern() == LedPattern::sure);
}
