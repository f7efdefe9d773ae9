// SPDX-License-Identifier: Apache-2.0
// The README's table of faults, row by row: what fails is named, the pose goes on with growing uncertainty or there is
// none, and all is well again within two seconds of the device's return.
#include <doctest/doctest.h>

#include "tests/robot/test_robot.h"

namespace touchline::test {
namespace {

constexpr MonotonicNs second = one_second;

/// Runs until the robot knows where it is.
void settle(TestRobot& robot) {
  robot.run(4 * second);
  REQUIRE(robot.report.estimate.valid);
  REQUIRE(robot.error() < 0.15F);
  REQUIRE(robot.report.led == LedPattern::sure);
  REQUIRE_FALSE(robot.report.faults.any());
}

void check_well(TestRobot& robot) {
  CHECK_FALSE(robot.report.faults.any());
  CHECK(robot.error() < 0.15F);
  CHECK(robot.camera.lent == 0);
}

TEST_CASE("camera missing at start: no pose, said so; found when it comes") {
  TestRobot robot;
  robot.camera.mode = TestCamera::Mode::missing;
  robot.run(3 * second);
  CHECK(robot.reports >= 28);
  CHECK_FALSE(robot.report.estimate.valid);
  CHECK(robot.has(Fault::camera_missing));
  CHECK(robot.panel.pattern() == LedPattern::no_camera);
  robot.camera.mode = TestCamera::Mode::good;
  robot.run(2 * second);
  CHECK(robot.report.from_frame);
  CHECK_FALSE(robot.has(Fault::camera_missing));
  robot.run(2 * second);
  check_well(robot);
}

struct CameraRow {
  TestCamera::Mode mode;
  Fault fault;
};

TEST_CASE("camera unplugged, stalled, damaged, black, of another size: the pose fades and comes back") {
  for (const CameraRow& row : {CameraRow{TestCamera::Mode::missing, Fault::camera_missing},
                               CameraRow{TestCamera::Mode::stalled, Fault::camera_stalled},
                               CameraRow{TestCamera::Mode::damaged, Fault::camera_damaged},
                               CameraRow{TestCamera::Mode::black, Fault::camera_black},
                               CameraRow{TestCamera::Mode::wrong_size, Fault::camera_size}}) {
    INFO(doctest::String(to_string(row.fault)));
    TestRobot robot;
    settle(robot);
    const float sure = robot.sigma();
    const float confidence = robot.report.estimate.confidence;
    robot.camera.mode = row.mode;
    robot.gait.mode = TestGait::Mode::silent;  // so that the motion is not known either
    robot.run(2 * second);
    CHECK(robot.has(row.fault));
    if (row.fault == Fault::camera_stalled) CHECK(robot.camera.health().opened > 1);  // opened anew
    CHECK_FALSE(robot.report.from_frame);
    CHECK(robot.report.estimate.valid);
    CHECK(robot.sigma() > sure);
    CHECK(robot.report.estimate.confidence < confidence);
    CHECK(robot.report.led != LedPattern::sure);
    robot.run(20 * second);
    CHECK_FALSE(robot.report.estimate.valid);  // after so long it says that it has none
    robot.camera.mode = TestCamera::Mode::good;
    robot.gait.mode = TestGait::Mode::good;
    robot.run(2 * second);
    CHECK(robot.report.from_frame);
    robot.run(2 * second);
    check_well(robot);
  }
}

TEST_CASE("a camera that refuses the format is named") {
  TestRobot robot;
  robot.camera.mode = TestCamera::Mode::refused;
  robot.run(second);
  CHECK(robot.has(Fault::camera_size));
  CHECK_FALSE(robot.has(Fault::camera_missing));
}

TEST_CASE("without pictures the pose follows the odometry") {
  TestRobot robot;
  settle(robot);
  const Pose2 before = robot.report.estimate.pose;
  robot.camera.mode = TestCamera::Mode::missing;
  robot.gait.ahead_speed = 0.2F;
  robot.run(2 * second);
  REQUIRE(robot.report.estimate.valid);
  const Pose2 step = compose(inverse(before), robot.report.estimate.pose);
  CHECK(step.x == doctest::Approx(0.4F).epsilon(0.1));
  CHECK(robot.report.odometry_used);
}

TEST_CASE("IMU missing, unplugged, silent, garbled: the pose goes on without it") {
  for (const auto& row :
       {std::pair{TestImu::Mode::missing, Fault::imu_missing}, std::pair{TestImu::Mode::silent, Fault::imu_stale},
        std::pair{TestImu::Mode::garbage, Fault::imu_garbage}}) {
    const auto mode = row.first;
    const Fault fault = row.second;
    INFO(doctest::String(to_string(fault)));
    TestRobot robot;
    settle(robot);
    CHECK(robot.report.yaw_used);
    robot.imu.mode = mode;
    robot.run(3 * second);
    CHECK(robot.has(fault));
    CHECK_FALSE(robot.report.yaw_used);
    CHECK(robot.error() < 0.15F);
    CHECK(robot.panel.pattern() == LedPattern::fault);
    robot.imu.mode = TestImu::Mode::good;
    robot.run(2 * second);
    CHECK(robot.report.yaw_used);
    robot.run(second);
    check_well(robot);
  }
}

TEST_CASE("the IMU's yaw jumps: the jump is not believed") {
  TestRobot robot;
  settle(robot);
  robot.imu.yaw += 2.0F;  // a new zero
  robot.run(second);
  CHECK(robot.has(Fault::imu_jump));
  CHECK(robot.report.yaw_jumps == 1);
  CHECK(robot.error() < 0.15F);
  CHECK(robot.report.yaw_used);
  robot.run(3 * second);
  check_well(robot);
}

TEST_CASE("an IMU that comes back with a new zero does not pick the wrong half") {
  TestRobot robot;
  settle(robot);
  robot.imu.mode = TestImu::Mode::missing;
  robot.run(second);
  robot.imu.yaw += math::pi;
  robot.imu.mode = TestImu::Mode::good;
  robot.run(3 * second);
  CHECK(robot.report.yaw_used);
  check_well(robot);
}

TEST_CASE("gait link missing, silent, corrupt: the motion is unknown, the pictures carry the pose") {
  for (const auto& row :
       {std::pair{TestGait::Mode::missing, Fault::gait_missing}, std::pair{TestGait::Mode::silent, Fault::gait_silent},
        std::pair{TestGait::Mode::corrupt, Fault::gait_corrupt}}) {
    const auto mode = row.first;
    const Fault fault = row.second;
    INFO(doctest::String(to_string(fault)));
    TestRobot robot;
    settle(robot);
    CHECK(robot.report.odometry_used);
    robot.gait.mode = mode;
    robot.run(3 * second);
    CHECK(robot.has(fault));
    CHECK_FALSE(robot.report.odometry_used);
    CHECK(robot.report.estimate.valid);
    CHECK(robot.error() < 0.3F);
    robot.gait.mode = TestGait::Mode::good;
    robot.run(2 * second);
    CHECK(robot.report.odometry_used);
    robot.run(2 * second);
    check_well(robot);
  }
}

TEST_CASE("the gait controller restarts: no step, said so") {
  TestRobot robot;
  robot.gait.state.odometry = {3.0F, 2.0F, 1.0F};
  settle(robot);
  robot.gait.state.odometry = {};
  ++robot.gait.state.boot_id;
  robot.run(second);
  CHECK(robot.has(Fault::gait_restarted));
  CHECK(robot.error() < 0.15F);
  robot.run(3 * second);
  check_well(robot);
}

TEST_CASE("odometry that leaps is no step") {
  TestRobot robot;
  settle(robot);
  robot.gait.state.odometry.x += 2.0F;
  robot.run(second);
  CHECK(robot.has(Fault::gait_jump));
  CHECK(robot.report.odometry_jumps == 1);
  CHECK(robot.error() < 0.3F);
}

TEST_CASE("odometry that no robot can walk, on and on: a jump is named and no silence") {
  TestRobot robot;
  settle(robot);
  robot.gait.ahead_speed = 50.0F;
  robot.run(3 * second);
  CHECK(robot.has(Fault::gait_jump));
  CHECK_FALSE(robot.has(Fault::gait_silent));
  CHECK_FALSE(robot.report.odometry_used);
  CHECK(robot.panel.pattern() == LedPattern::fault);
  robot.gait.ahead_speed = 0.0F;
  robot.run(5 * second);
  check_well(robot);
}

TEST_CASE("before the first picture the report says which camera attitude would be used") {
  TestRobot robot;
  robot.camera.mode = TestCamera::Mode::missing;
  robot.run(second);
  CHECK(robot.reports > 0);
  CHECK(robot.report.camera.height == scene().config.mount.height);
  robot.gait.state.has_camera_attitude = true;
  robot.gait.state.camera_height = 0.43F;
  robot.gait.state.camera_pitch = 0.3F;
  robot.run(second);
  CHECK(robot.report.attitude_source == AttitudeSource::gait_link);
  CHECK(robot.report.camera.height == doctest::Approx(0.43F));
}

TEST_CASE("a camera that is there at start is reported with its first picture, not before") {
  TestRobot robot;
  robot.run(400 * one_millisecond);
  CHECK(robot.report.frames > 0);
  CHECK(static_cast<std::uint64_t>(robot.reports) == robot.report.frames);
}

TEST_CASE("fallen or lifted: no pose meanwhile, and a start from nothing after it") {
  for (const Fault fault : {Fault::fallen, Fault::lifted}) {
    INFO(doctest::String(to_string(fault)));
    TestRobot robot;
    settle(robot);
    (fault == Fault::fallen ? robot.gait.state.fallen : robot.gait.state.lifted) = true;
    robot.run(2 * second);
    CHECK(robot.has(fault));
    CHECK_FALSE(robot.report.estimate.valid);
    robot.gait.state.fallen = robot.gait.state.lifted = false;
    robot.run(4 * second);
    check_well(robot);
  }
}

TEST_CASE("the clock leaps: said so, and the camera did not stall") {
  TestRobot robot;
  settle(robot);
  robot.clock.advance(3600 * second);
  robot.run(second);
  CHECK(robot.has(Fault::clock_jump));
  CHECK_FALSE(robot.has(Fault::camera_stalled));
  CHECK(robot.camera.health().opened == 1);
  robot.run(4 * second);
  check_well(robot);
}

TEST_CASE("frames out of order are not used; a camera whose time starts anew is") {
  TestRobot robot;
  settle(robot);
  const std::uint64_t frames = robot.report.frames;
  robot.camera.back_in_time = 3 * second;
  robot.run(second);
  CHECK(robot.has(Fault::camera_stale));
  CHECK(robot.report.frames == frames);
  robot.camera.back_in_time = -10 * second;  // from the future
  robot.run(second);
  CHECK(robot.report.frames == frames);
  robot.camera.back_in_time = 0;
  robot.run(3 * second);
  check_well(robot);
}

TEST_CASE("an output that fails is shown") {
  TestRobot robot;
  settle(robot);
  robot.loop.note_output_failure();
  robot.run(second);
  CHECK(robot.has(Fault::output));
  robot.run(3 * second);
  check_well(robot);
}

TEST_CASE("a panel that is missing or unplugged changes nothing but its own health") {
  TestRobot robot;
  robot.panel.opens.add(Status::disconnected, 3);
  robot.run(second);
  CHECK(robot.has(Fault::panel_missing));
  robot.run(4 * second);
  check_well(robot);
  robot.panel.presses.add(Status::disconnected);
  robot.panel.opens.add(Status::disconnected);
  robot.run(400 * one_millisecond);
  CHECK(robot.has(Fault::panel_missing));
  robot.run(2 * second);
  check_well(robot);
}

TEST_CASE("everything gone at once, and back") {
  TestRobot robot;
  settle(robot);
  robot.camera.mode = TestCamera::Mode::missing;
  robot.imu.mode = TestImu::Mode::missing;
  robot.gait.mode = TestGait::Mode::missing;
  robot.run(20 * second);
  CHECK_FALSE(robot.report.estimate.valid);
  robot.camera.mode = TestCamera::Mode::good;
  robot.imu.mode = TestImu::Mode::good;
  robot.gait.mode = TestGait::Mode::good;
  robot.run(4 * second);
  CHECK(robot.error() < 0.15F);
}

}  // namespace
}  // namespace touchline::test
