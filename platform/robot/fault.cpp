// SPDX-License-Identifier: Apache-2.0
#include "platform/robot/fault.h"

namespace touchline {

const char* to_string(Fault fault) {
  switch (fault) {
    case Fault::camera_missing: return "camera_missing";
    case Fault::camera_stalled: return "camera_stalled";
    case Fault::camera_damaged: return "camera_damaged";
    case Fault::camera_size: return "camera_size";
    case Fault::camera_black: return "camera_black";
    case Fault::camera_stale: return "camera_stale";
    case Fault::imu_missing: return "imu_missing";
    case Fault::imu_stale: return "imu_stale";
    case Fault::imu_garbage: return "imu_garbage";
    case Fault::imu_jump: return "imu_jump";
    case Fault::gait_missing: return "gait_missing";
    case Fault::gait_silent: return "gait_silent";
    case Fault::gait_corrupt: return "gait_corrupt";
    case Fault::gait_restarted: return "gait_restarted";
    case Fault::gait_jump: return "gait_jump";
    case Fault::fallen: return "fallen";
    case Fault::lifted: return "lifted";
    case Fault::panel_missing: return "panel_missing";
    case Fault::clock_jump: return "clock_jump";
    case Fault::output: return "output";
    case Fault::count: break;
  }
  return "unknown";
}

}  // namespace touchline
