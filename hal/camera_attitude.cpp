// SPDX-License-Identifier: Apache-2.0
#include "hal/camera_attitude.h"

namespace touchline {
namespace {

Mat3 attitude(float yaw, float pitch, float roll) {
  return multiply(multiply(rotation_z(yaw), rotation_y(pitch)), rotation_x(roll));
}
Vec3 plus(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 minus(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }

/// The angles of Rz(yaw) Ry(pitch) Rx(roll). Looking straight down, yaw and roll turn about the same axis: all in yaw.
void set_angles(const Mat3& rotation, CameraAttitude& result) {
  const auto& m = rotation.m;
  result.pitch = math::asin(-m[2][0]);
  if (math::hypot(m[0][0], m[1][0]) < 1e-4F) {
    result.yaw = math::atan2(-m[0][1], m[1][1]);
    result.roll = 0.0F;
    return;
  }
  result.yaw = math::atan2(m[1][0], m[0][0]);
  result.roll = math::atan2(m[2][1], m[2][2]);
}

/// carpet <- torso (tilt about its pivot) <- head (pan, then tilt, about the neck) <- camera.
CameraAttitude from_torso_and_head(const CameraMount& mount, const CameraAttitudeInput& input) {
  const Mat3 torso = attitude(0.0F, input.torso_pitch, input.torso_roll);
  const Mat3 head = attitude(input.head_pan, input.head_tilt, 0.0F);
  const Vec3 camera{mount.x, mount.y, mount.height};
  const Vec3 in_torso = plus(mount.neck, multiply(head, minus(camera, mount.neck)));
  const Vec3 place = plus(mount.tilt_pivot, multiply(torso, minus(in_torso, mount.tilt_pivot)));
  CameraAttitude result;
  set_angles(multiply(multiply(torso, head), attitude(mount.yaw, mount.pitch, mount.roll)), result);
  result.x = place.x;
  result.y = place.y;
  result.height = input.has_camera ? input.camera_height : place.z;
  result.source = AttitudeSource::imu_head;
  return result;
}

}  // namespace

const char* to_string(AttitudeSource source) {
  switch (source) {
    case AttitudeSource::config: return "config";
    case AttitudeSource::gait_link: return "gait_link";
    case AttitudeSource::imu_head: return "imu_head";
  }
  return "unknown";
}

CameraAttitude camera_attitude(const CameraMount& mount, const CameraAttitudeInput& input) {
  if (input.has_torso_tilt && input.has_head) return from_torso_and_head(mount, input);
  CameraAttitude result{mount.x, mount.y, mount.height, mount.yaw, mount.pitch, mount.roll, AttitudeSource::config};
  if (input.has_head) result.yaw = wrap_angle(mount.yaw + input.head_pan);
  if (input.has_camera) {
    result.height = input.camera_height;
    result.pitch = input.camera_pitch;
    result.roll = input.camera_roll;
    result.source = AttitudeSource::gait_link;
  }
  return result;
}

}  // namespace touchline
