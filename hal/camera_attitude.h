// SPDX-License-Identifier: Apache-2.0
// Where the camera is and where it looks, for one frame (reading note 18): from the torso's tilt and the head's joints
// where both are known, else from what the gait controller says of the camera, else from the config.
#pragma once

#include <cstdint>

#include "platform/core/geometry.h"

namespace touchline {

/// The robot's build: robot upright, head straight. Metres and radians; axes x forward, y left, z up.
struct CameraMount {
  float x = 0.0F;  // camera in the robot's frame
  float y = 0.0F;
  float height = 0.5F;           // of the camera above the carpet
  float yaw = 0.0F;              // > 0 looks left
  float pitch = 0.0F;            // > 0 looks down
  float roll = 0.0F;             // > 0 lowers the right side
  Vec3 neck{0.0F, 0.0F, 0.45F};  // where the axes of pan and tilt meet; the head turns the camera about it
  Vec3 tilt_pivot{};             // the torso leans about this point; its default is between the feet
};

enum class AttitudeSource : std::uint8_t {
  config,     // the mount as configured, at rest
  gait_link,  // the controller's camera height, pitch and roll
  imu_head,   // the torso's roll and pitch with the head's pan and tilt
};
/// "config", "gait_link" or "imu_head".
const char* to_string(AttitudeSource source);

struct CameraAttitudeInput {
  bool has_torso_tilt = false;
  float torso_roll = 0.0F;   // > 0 lowers the right side
  float torso_pitch = 0.0F;  // > 0 bows forward
  bool has_head = false;
  float head_pan = 0.0F;    // > 0 looks left
  float head_tilt = 0.0F;   // > 0 looks down
  bool has_camera = false;  // by the gait link
  float camera_height = 0.0F;
  float camera_pitch = 0.0F;
  float camera_roll = 0.0F;
};

/// The camera in the robot's frame, as vision wants it.
struct CameraAttitude {
  float x = 0.0F, y = 0.0F, height = 0.0F;
  float yaw = 0.0F, pitch = 0.0F, roll = 0.0F;
  AttitudeSource source = AttitudeSource::config;
};

/// The height comes from the gait link wherever it gives one: it knows how far the knees are bent.
CameraAttitude camera_attitude(const CameraMount& mount, const CameraAttitudeInput& input);

}  // namespace touchline
