// SPDX-License-Identifier: Apache-2.0
#include "vision/camera_movement.h"

#include <doctest/doctest.h>

#include "platform/core/angle.h"

using namespace touchline;

namespace {

CameraPose camera(float height, float pitch_deg) {
  CameraPose pose;
  pose.height = height;
  pose.pitch = radians(pitch_deg);
  return pose;
}

}  // namespace

TEST_CASE("a robot that stands has not moved; the newest frame never has") {
  CameraMovement movement;
  for (int i = 0; i < 3; ++i) movement.remember(camera(0.5F, 30.0F), {});
  CHECK(movement.since(2) == 0.0F);
  movement.remember(camera(0.5F, 35.0F), {0.1F, 0.0F, 0.2F});
  CHECK(movement.since(0) == 0.0F);
}

TEST_CASE("steps add up, as seen from one camera height; turns of head and robot add up") {
  CameraMovement movement;
  movement.remember(camera(0.5F, 30.0F), {});
  movement.remember(camera(0.5F, 30.0F), {0.03F, 0.0F, 0.0F});
  movement.remember(camera(0.5F, 30.0F), {0.0F, 0.04F, 0.0F});
  CHECK(movement.since(1) == doctest::Approx(0.08));
  CHECK(movement.since(2) == doctest::Approx(0.10));
  movement.remember(camera(0.5F, 28.0F), {0.0F, 0.0F, radians(3.0F)});
  CHECK(movement.since(1) == doctest::Approx(static_cast<double>(radians(5.0F))));
}

TEST_CASE("a head that turns back what the robot has turned sees the same picture") {
  CameraMovement movement;
  movement.remember(camera(0.5F, 30.0F), {});
  CameraPose turned = camera(0.5F, 30.0F);
  turned.yaw = radians(-10.0F);
  movement.remember(turned, {0.0F, 0.0F, radians(10.0F)});
  CHECK(movement.since(1) == doctest::Approx(0.0));
}
