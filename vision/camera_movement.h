// SPDX-License-Identifier: Apache-2.0
// How far the camera has moved since the frames of the FIFO were taken: a frame that moved blurs the mean (reading of
// section IV-A: the mean is for a robot that stands).
#pragma once

#include <array>

#include "platform/core/geometry.h"
#include "vision/image/frame_fifo.h"
#include "vision/lens/camera_pose.h"

namespace touchline {

class CameraMovement {
 public:
  /// Call once a frame. `odometry` is the robot's step since the frame before.
  void remember(const CameraPose& camera, const Pose2& odometry);
  /// Since the frame of that age (0: the newest; below max_fifo_depth), radians: the turn, and the step as it is seen
  /// at the nearest ground, one camera height away.
  [[nodiscard]] float since(int age) const;

 private:
  struct Held {
    CameraPose camera;
    Pose2 odometry;
  };
  std::array<Held, max_fifo_depth> held_{};  // the newest first
};

}  // namespace touchline
