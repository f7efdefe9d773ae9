// SPDX-License-Identifier: Apache-2.0
// Which source the camera's attitude comes from, and the geometry of torso, head and camera.
#include "hal/camera_attitude.h"

#include <doctest/doctest.h>

namespace touchline {
namespace {

CameraMount mount() {
  CameraMount m;
  m.x = 0.05F;
  m.height = 0.55F;
  m.pitch = radians(10.0F);
  m.neck = {0.0F, 0.0F, 0.50F};
  return m;
}

TEST_CASE("without anything else the config holds") {
  const CameraAttitude a = camera_attitude(mount(), {});
  CHECK(a.source == AttitudeSource::config);
  CHECK(a.height == 0.55F);
  CHECK(a.pitch == radians(10.0F));
}

TEST_CASE("the gait link's camera attitude comes before the config, and the head's pan with it") {
  CameraAttitudeInput input;
  input.has_camera = true;
  input.camera_height = 0.5F;
  input.camera_pitch = 0.4F;
  input.camera_roll = -0.1F;
  CameraAttitude a = camera_attitude(mount(), input);
  CHECK(a.source == AttitudeSource::gait_link);
  CHECK(a.height == 0.5F);
  CHECK(a.pitch == 0.4F);
  CHECK(a.roll == -0.1F);
  CHECK(a.yaw == 0.0F);
  input.has_head = true;
  input.head_pan = 0.7F;
  CHECK(camera_attitude(mount(), input).yaw == doctest::Approx(0.7F));
}

TEST_CASE("the torso's tilt needs the head's joints, and then comes first") {
  CameraAttitudeInput input;
  input.has_torso_tilt = true;
  CHECK(camera_attitude(mount(), input).source == AttitudeSource::config);
  input.has_camera = true;
  input.camera_height = 0.48F;
  CHECK(camera_attitude(mount(), input).source == AttitudeSource::gait_link);
  input.has_head = true;
  const CameraAttitude a = camera_attitude(mount(), input);
  CHECK(a.source == AttitudeSource::imu_head);
  CHECK(a.height == 0.48F);
  CHECK(a.pitch == doctest::Approx(radians(10.0F)));
}

TEST_CASE("upright and straight is the mount as configured; pitches of torso, head and mount add up") {
  CameraAttitudeInput input;
  input.has_torso_tilt = input.has_head = true;
  CameraAttitude a = camera_attitude(mount(), input);
  CHECK(a.x == doctest::Approx(0.05F));
  CHECK(a.height == doctest::Approx(0.55F));
  CHECK(a.pitch == doctest::Approx(radians(10.0F)));
  input.torso_pitch = 0.1F;
  input.head_tilt = 0.2F;
  a = camera_attitude(mount(), input);
  CHECK(a.pitch == doctest::Approx(0.3F + radians(10.0F)));
  CHECK(a.roll == doctest::Approx(0.0F));
  CHECK(a.x > 0.09F);  // bowing brings the camera forward and down
  CHECK(a.height < 0.55F);
}

TEST_CASE("a head turned to the left makes of the torso's pitch the camera's roll") {
  CameraMount m = mount();
  m.pitch = 0.0F;
  CameraAttitudeInput input;
  input.has_torso_tilt = input.has_head = true;
  input.head_pan = math::half_pi;
  input.torso_pitch = 0.2F;
  const CameraAttitude a = camera_attitude(m, input);
  CHECK(a.yaw == doctest::Approx(math::half_pi));
  CHECK(a.pitch == doctest::Approx(0.0F).epsilon(1e-5));
  CHECK(a.roll == doctest::Approx(0.2F));  // bowing lowers the robot's front, which is the camera's right
  CHECK(a.y == doctest::Approx(0.05F));
}

TEST_CASE("a camera that looks straight down has an attitude too") {
  CameraMount m = mount();
  m.pitch = math::half_pi;
  CameraAttitudeInput input;
  input.has_torso_tilt = input.has_head = true;
  input.head_pan = 0.3F;
  const CameraAttitude a = camera_attitude(m, input);
  CHECK(a.pitch == doctest::Approx(math::half_pi).epsilon(1e-3));
  CHECK(wrap_angle(a.yaw - a.roll) == doctest::Approx(0.3F).epsilon(1e-3));
}

TEST_CASE("each source has a name") {
  CHECK(to_string(AttitudeSource::imu_head) == doctest::String("imu_head"));
  CHECK(to_string(AttitudeSource::gait_link) == doctest::String("gait_link"));
  CHECK(to_string(AttitudeSource::config) == doctest::String("config"));
}

}  // namespace
}  // namespace touchline
