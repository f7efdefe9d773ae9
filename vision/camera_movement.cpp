// SPDX-License-Identifier: Apache-2.0
#include "vision/camera_movement.h"

#include <algorithm>

#include "platform/core/elementary.h"

namespace touchline {

void CameraMovement::remember(const CameraPose& camera, const Pose2& odometry) {
  std::copy_backward(held_.begin(), held_.end() - 1, held_.end());
  held_[0] = {camera, odometry};
}

float CameraMovement::since(int age) const {
  Pose2 step;
  for (int i = age - 1; i >= 0; --i) step = compose(step, held_[static_cast<std::size_t>(i)].odometry);
  const CameraPose& now = held_[0].camera;
  const CameraPose& then = held_[static_cast<std::size_t>(age)].camera;
  const float turn = math::abs(wrap_angle(now.pitch - then.pitch)) + math::abs(wrap_angle(now.roll - then.roll)) +
                     math::abs(wrap_angle(now.yaw - then.yaw + step.theta));
  const float travel =
      math::hypot(now.x - then.x + step.x, now.y - then.y + step.y) + math::abs(now.height - then.height);
  return turn + travel / now.height;
}

}  // namespace touchline
