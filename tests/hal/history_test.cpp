// SPDX-License-Identifier: Apache-2.0
// Where the robot was, and how it stood, at the time of a frame; and what is no motion.
#include "hal/history.h"

#include <doctest/doctest.h>

#include <limits>

#include "hal/odometry_history.h"
#include "hal/yaw_history.h"

namespace touchline {
namespace {

constexpr MonotonicNs ms = one_millisecond;

GaitSample gait(MonotonicNs time, float x, float theta = 0.0F, std::uint32_t boot = 1) {
  GaitSample sample;
  sample.time = time;
  sample.boot_id = boot;
  sample.odometry = {x, 0.0F, theta};
  return sample;
}
ImuSample imu(MonotonicNs time, float yaw) {
  ImuSample sample;
  sample.time = time;
  sample.yaw = yaw;
  return sample;
}

TEST_CASE("a history interpolates, runs a little ahead, and says when it does not know") {
  History<float, 4> history;
  CHECK(history.at(0, ms).status() == Status::not_ready);
  CHECK(history.push(10 * ms, 1.0F) == Status::ok);
  CHECK(history.at(10 * ms, ms).value() == 1.0F);
  CHECK(history.push(20 * ms, 2.0F) == Status::ok);
  CHECK(history.push(20 * ms, 3.0F) == Status::stale);
  CHECK(history.push(30 * ms, 4.0F) == Status::ok);
  CHECK(history.at(15 * ms, 0).value() == doctest::Approx(1.5F));
  CHECK(history.at(25 * ms, 0).value() == doctest::Approx(3.0F));
  CHECK(history.at(30 * ms, 0).value() == doctest::Approx(4.0F));
  CHECK(history.at(35 * ms, 10 * ms).value() == doctest::Approx(5.0F));
  CHECK(history.at(41 * ms, 10 * ms).status() == Status::stale);
  CHECK(history.at(9 * ms, ms).status() == Status::stale);
  CHECK(history.push(40 * ms, 4.0F) == Status::ok);
  CHECK(history.push(50 * ms, 4.0F) == Status::ok);  // the fifth pushes the first out
  CHECK(history.at(15 * ms, 0).status() == Status::stale);
  CHECK(history.at(20 * ms, 0).value() == doctest::Approx(2.0F));
}

TEST_CASE("poses are interpolated the short way round") {
  const Pose2 half = interpolate(Pose2{0, 0, 3.0F}, Pose2{1, 2, -3.0F}, 0.5F);
  CHECK(half.x == doctest::Approx(0.5F));
  CHECK(half.y == doctest::Approx(1.0F));
  CHECK(math::abs(half.theta) == doctest::Approx(math::pi));
}

TEST_CASE("a late frame gets the step between the times of the frames, not of their arrival") {
  OdometryHistory odometry;
  for (int i = 0; i <= 20; ++i) CHECK(odometry.push(gait(i * 10 * ms, 0.005F * static_cast<float>(i))) == Status::ok);
  const auto step = odometry.step(33 * ms, 87 * ms);
  REQUIRE(step.ok());
  CHECK(step.value().x == doctest::Approx(0.027F));
  CHECK(odometry.step(-1, 87 * ms).status() == Status::stale);
}

TEST_CASE("a restart of the controller is no step, and the path goes on") {
  OdometryHistory odometry;
  CHECK(odometry.push(gait(10 * ms, 3.00F)) == Status::ok);
  CHECK(odometry.push(gait(20 * ms, 3.01F)) == Status::ok);
  CHECK(odometry.push(gait(500 * ms, 0.0F, 0.0F, 2)) == Status::ok);
  CHECK(odometry.push(gait(510 * ms, 0.01F, 0.0F, 2)) == Status::ok);
  CHECK(odometry.newest().x == doctest::Approx(0.02F));
  CHECK(odometry.jumps() == 0);
}

TEST_CASE("an implausible jump is no step: it comes back, or it stays") {
  OdometryHistory odometry;
  CHECK(odometry.push(gait(10 * ms, 0.00F)) == Status::ok);
  CHECK(odometry.push(gait(20 * ms, 5.00F)) == Status::corrupt);
  CHECK(odometry.push(gait(30 * ms, 0.02F)) == Status::ok);  // it was one wild sample
  CHECK(odometry.newest().x == doctest::Approx(0.02F));
  CHECK(odometry.push(gait(40 * ms, -7.00F, 2.0F)) == Status::corrupt);
  CHECK(odometry.push(gait(50 * ms, -7.00F, 2.0F)) == Status::ok);  // it has moved for good
  CHECK(odometry.newest().x == doctest::Approx(0.02F));
  CHECK(odometry.push(gait(60 * ms, -7.00F, 2.5F)) == Status::corrupt);  // half a radian in 10 ms
  CHECK(odometry.jumps() == 3);
  CHECK(odometry.push(gait(70 * ms, std::numeric_limits<float>::quiet_NaN())) == Status::invalid_argument);
  CHECK(odometry.push(gait(40 * ms, -7.0F, 2.0F)) == Status::stale);
}

TEST_CASE("steps are in the robot's frame whatever way it looked at boot") {
  OdometryHistory odometry;
  CHECK(odometry.push(gait(10 * ms, 1.0F, math::half_pi)) == Status::ok);
  GaitSample next = gait(20 * ms, 1.0F, math::half_pi);
  next.odometry.y = 0.01F;  // one centimetre along the boot's left: forward for the robot
  CHECK(odometry.push(next) == Status::ok);
  const auto step = odometry.step(10 * ms, 20 * ms);
  CHECK(step.value().x == doctest::Approx(0.01F));
  CHECK(step.value().y == doctest::Approx(0.0F));
}

TEST_CASE("a jump of the yaw is not used, and a new zero of the device does not turn the robot") {
  YawHistory yaw;
  CHECK(yaw.push(imu(10 * ms, 1.0F)) == Status::ok);
  CHECK(yaw.push(imu(20 * ms, -2.0F)) == Status::corrupt);
  CHECK(yaw.push(imu(30 * ms, 1.1F)) == Status::ok);
  CHECK(yaw.newest().yaw == doctest::Approx(1.1F));
  CHECK(yaw.push(imu(40 * ms, 0.0F)) == Status::corrupt);
  CHECK(yaw.push(imu(50 * ms, 0.0F)) == Status::ok);
  CHECK(yaw.push(imu(60 * ms, 0.05F)) == Status::ok);
  CHECK(yaw.newest().yaw == doctest::Approx(1.15F));
  CHECK(yaw.jumps() == 2);
  CHECK(yaw.at(55 * ms).value().yaw == doctest::Approx(1.125F));
}

TEST_CASE("after a gap the yaw goes on where the odometry says that the robot has turned to") {
  YawHistory yaw;
  CHECK(yaw.push(imu(10 * ms, 1.0F)) == Status::ok);
  yaw.reattach(0.5F);
  CHECK(yaw.push(imu(5000 * ms, 0.0F)) == Status::ok);  // power was lost, the zero with it
  CHECK(yaw.newest().yaw == doctest::Approx(1.5F));
  CHECK(yaw.push(imu(5010 * ms, 0.02F)) == Status::ok);
  CHECK(yaw.newest().yaw == doctest::Approx(1.52F));
  CHECK(yaw.jumps() == 0);
}

TEST_CASE("tilt is interpolated only where both samples have it") {
  YawHistory yaw;
  ImuSample a = imu(10 * ms, 0.0F);
  ImuSample b = imu(20 * ms, 0.1F);
  a.has_tilt = b.has_tilt = true;
  b.pitch = 0.2F;
  CHECK(yaw.push(a) == Status::ok);
  CHECK(yaw.push(b) == Status::ok);
  CHECK(yaw.at(15 * ms).value().pitch == doctest::Approx(0.1F));
  CHECK(yaw.at(15 * ms).value().has_tilt);
  CHECK(yaw.push(imu(30 * ms, 0.1F)) == Status::ok);
  CHECK_FALSE(yaw.at(25 * ms).value().has_tilt);
  b.time = 40 * ms;
  b.roll = std::numeric_limits<float>::infinity();
  CHECK(yaw.push(b) == Status::invalid_argument);
}

}  // namespace
}  // namespace touchline
