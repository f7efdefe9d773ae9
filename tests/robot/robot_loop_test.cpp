// SPDX-License-Identifier: Apache-2.0
// The robot's loop when all is well: buttons, light, sources of the attitude, late frames, and no allocation.
#include "platform/robot/robot_loop.h"

#include <doctest/doctest.h>

#include "platform/robot/picture_check.h"
#include "tests/robot/test_robot.h"
#include "tests/support/heap_guard.h"

namespace touchline::test {
namespace {

constexpr MonotonicNs second = one_second;

TEST_CASE("the robot finds where it stands and shows that it is sure") {
  TestRobot robot;
  robot.run(4 * second);
  CHECK(robot.error() < 0.15F);
  CHECK(robot.panel.pattern() == LedPattern::sure);
  CHECK(robot.panel.shown.front() != LedPattern::sure);
  CHECK(robot.report.from_frame);
  CHECK(robot.report.yaw_used);
  CHECK(robot.report.odometry_used);
  CHECK(robot.report.frames > 15);
  CHECK(robot.report.line_points > 0);
  CHECK(robot.camera.lent == 0);
}

TEST_CASE("the yaw is used once the short press has stored the goal's") {
  TestRobot robot;
  RobotConfig config = scene().config;
  config.goal_yaw_known = false;
  RobotLoop loop({&robot.camera, &robot.imu, &robot.gait, &robot.panel, &robot.clock}, robot.storage->memory(),
                 *robot.localizer);
  REQUIRE(loop.configure(config) == Status::ok);
  const auto run = [&](MonotonicNs duration) {
    for (const MonotonicNs end = robot.clock.now() + duration; robot.clock.now() < end;) (void)loop.turn(robot.report);
  };
  robot.imu.yaw = 0.75F;
  run(second);
  CHECK_FALSE(loop.goal_yaw_known());
  CHECK_FALSE(robot.report.yaw_used);
  robot.panel.presses.add({robot.clock.now(), ButtonPress::short_press});
  run(second);
  CHECK(loop.goal_yaw_known());
  CHECK(loop.goal_yaw() == doctest::Approx(0.75F));
  CHECK(robot.report.yaw_used);
}

TEST_CASE("a press without a yaw stores nothing") {
  TestRobot robot;
  RobotConfig config = scene().config;
  config.goal_yaw_known = false;
  RobotLoop loop({&robot.camera, &robot.imu, &robot.gait, &robot.panel, &robot.clock}, robot.storage->memory(),
                 *robot.localizer);
  REQUIRE(loop.configure(config) == Status::ok);
  robot.imu.mode = TestImu::Mode::missing;
  robot.panel.presses.add({robot.clock.now(), ButtonPress::short_press});
  for (const MonotonicNs end = robot.clock.now() + second; robot.clock.now() < end;) (void)loop.turn(robot.report);
  CHECK(robot.panel.health().open);
  CHECK_FALSE(loop.goal_yaw_known());
  CHECK(loop.goal_yaw_presses() == 0);
}

TEST_CASE("the goal's yaw can be told as the device reads it, through a new zero of the device") {
  TestRobot robot;
  robot.imu.yaw = 0.75F;
  robot.run(second);
  CHECK(robot.loop.goal_yaw_presses() == 0);
  robot.panel.presses.add({robot.clock.now(), ButtonPress::short_press});
  robot.run(second);
  CHECK(robot.loop.goal_yaw_presses() == 1);
  CHECK(robot.loop.goal_yaw_reading() == doctest::Approx(0.75));
  robot.imu.yaw = -2.25F;  // its zero is another from now on: the robot has not moved
  robot.run(second);
  CHECK(robot.loop.goal_yaw() == doctest::Approx(0.75));
  CHECK(robot.loop.goal_yaw_reading() == doctest::Approx(-2.25));
}

TEST_CASE("thresholds change while the robot plays: the pose stays") {
  TestRobot robot;
  robot.run(4 * second);
  REQUIRE(robot.error() < 0.15F);
  RobotConfig config = scene().config;
  config.vision.spur_px += 2;
  for (const int particles : {config.localizer.particles, 300, 150}) {
    const std::uint64_t before = robot.report.frames;
    config.localizer.particles = particles;
    REQUIRE(robot.loop.configure(config) == Status::ok);
    robot.run(500 * one_millisecond);
    CHECK(robot.report.frames >= before + 2);
    CHECK(robot.report.estimate.confidence > 0.5F);
    CHECK(robot.error() < 0.15F);
  }
}

TEST_CASE("a configuration that is refused leaves nothing behind") {
  TestRobot robot;
  robot.run(second);
  const std::uint64_t before = robot.report.frames;
  RobotConfig config = scene().config;
  config.vision.frame_width /= 2;
  config.vision.frame_height /= 2;
  config.localizer.particles = -1;
  const char* what = nullptr;
  CHECK(robot.loop.configure(config, &what) == Status::invalid_argument);
  robot.run(second);
  CHECK(robot.report.frames > before + 3);
  CHECK_FALSE(robot.has(Fault::camera_size));
}

TEST_CASE("the long press starts from nothing") {
  TestRobot robot;
  robot.run(4 * second);
  REQUIRE(robot.report.estimate.valid);
  robot.panel.presses.add({robot.clock.now(), ButtonPress::long_press});
  CHECK(robot.loop.turn(robot.report) != Status::end_of_data);
  robot.camera.mode = TestCamera::Mode::stalled;
  robot.run(500 * one_millisecond);
  CHECK_FALSE(robot.report.estimate.valid);
  robot.camera.mode = TestCamera::Mode::good;
  robot.run(4 * second);
  CHECK(robot.error() < 0.15F);
}

TEST_CASE("the source of the camera's attitude is in the report") {
  TestRobot robot;
  robot.run(second);
  CHECK(robot.report.attitude_source == AttitudeSource::config);
  GaitSample& gait = robot.gait.state;
  gait.has_camera_attitude = true;
  gait.camera_height = scene().config.mount.height;
  gait.camera_pitch = scene().config.mount.pitch;
  gait.camera_roll = scene().config.mount.roll;
  robot.run(second);
  CHECK(robot.report.attitude_source == AttitudeSource::gait_link);
  gait.has_head = true;
  robot.imu.tilt = true;
  robot.run(second);
  CHECK(robot.report.attitude_source == AttitudeSource::imu_head);
  robot.imu.mode = TestImu::Mode::silent;
  robot.run(second);
  CHECK(robot.report.attitude_source == AttitudeSource::gait_link);
}

TEST_CASE("a wrong value is refused by name") {
  TestRobot robot;
  RobotConfig config = scene().config;
  config.lens.focal_px = -1.0F;
  const char* what = nullptr;
  CHECK(robot.loop.configure(config, &what) == Status::invalid_argument);
  CHECK(what != nullptr);
  RobotLoop fresh({&robot.camera, nullptr, nullptr, nullptr, &robot.clock}, robot.storage->memory(), *robot.localizer);
  CHECK(fresh.turn(robot.report) == Status::invalid_argument);
}

TEST_CASE("a robot with a camera alone works too") {
  TestRobot robot;
  RobotLoop loop({&robot.camera, nullptr, nullptr, nullptr, &robot.clock}, robot.storage->memory(), *robot.localizer);
  REQUIRE(loop.configure(scene().config) == Status::ok);
  for (const MonotonicNs end = robot.clock.now() + 4 * second; robot.clock.now() < end;) (void)loop.turn(robot.report);
  CHECK_FALSE(robot.report.faults.any());
  CHECK(robot.report.frames > 15);
  CHECK_FALSE(robot.report.odometry_used);
}

TEST_CASE("the loop allocates nothing, in good and in bad times") {
  TestRobot robot;
  robot.run(second);
  const HeapGuard guard;
  robot.run(2 * second);
  robot.camera.mode = TestCamera::Mode::missing;
  robot.run(second);
  robot.camera.mode = TestCamera::Mode::black;
  robot.run(second);
  CHECK(guard.allocations() == 0);
}

TEST_CASE("black pictures of every format") {
  std::uint8_t pixels[64 * 4 * 3] = {};
  CHECK(brightest_sample({PixelFormat::rgb24, pixels, 64, 4, 192}) == 0);
  CHECK(brightest_sample({PixelFormat::rgb24, nullptr, 64, 4, 192}) == 0);
  for (auto& byte : pixels) byte = 16;
  CHECK(brightest_sample({PixelFormat::yuyv, pixels, 64, 4, 128}) == 0);
  for (auto& byte : pixels) byte = 0xFF;
  CHECK(brightest_sample({PixelFormat::yuyv, pixels, 64, 4, 128}) == 239);
  CHECK(brightest_sample({PixelFormat::bgr24, pixels, 64, 4, 192}) == 255);
  CHECK(brightest_sample({PixelFormat::rgb565, pixels, 64, 4, 128}) == 252);
}

}  // namespace
}  // namespace touchline::test
