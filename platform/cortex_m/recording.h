// SPDX-License-Identifier: Apache-2.0
// A recorded sequence as it lies in flash: camera frames, and what the sensors said with each. make_recording.cpp
// writes the one definition of `recording_in_flash` from a data set when the program is built.
#pragma once

#include <cstdint>
#include <span>

#include "platform/core/frame.h"
#include "platform/core/geometry.h"
#include "vision/lens/camera_pose.h"
#include "vision/lens/lens.h"

namespace touchline::board {

inline constexpr int frame_width = 320;  // sensors of microcontroller boards: OV2640, OV7670, MT9V034 at QVGA
inline constexpr int frame_height = 240;
inline constexpr std::size_t frame_bytes = std::size_t{frame_width} * frame_height * 2;

struct RecordedFrame {
  double time_s = 0.0;
  CameraPose camera;  // as measured at the time of the frame
  Pose2 odometry;     // robot's step since the frame before
  bool has_yaw = false;
  float yaw = 0.0F;  // IMU yaw minus the stored goal yaw, radians
};

struct Recording {
  const char* name = nullptr;
  const char* field = nullptr;  // a preset's name
  LensParameters lens;
  std::span<const RecordedFrame> frames;
  const std::uint8_t* pixels = nullptr;  // YUYV, frame after frame, frame_bytes each
};

extern const Recording recording_in_flash;

}  // namespace touchline::board
