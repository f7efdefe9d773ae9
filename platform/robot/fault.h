// SPDX-License-Identifier: Apache-2.0
// What can be wrong with the robot's devices, by name; a set of them is the health of a report.
#pragma once

#include <cstdint>

namespace touchline {

enum class Fault : std::uint8_t {
  camera_missing,  // cannot be opened
  camera_stalled,  // open, but no frame for a while
  camera_damaged,  // the driver flags frames as damaged
  camera_size,     // not the configured size or format
  camera_black,    // a lens cap, or no light
  camera_stale,    // frames came out of order, or with a time that cannot be
  imu_missing,
  imu_stale,    // open, but silent
  imu_garbage,  // reports that make no sense
  imu_jump,     // the yaw jumped, or got a new zero
  gait_missing,
  gait_silent,     // open, but no frame for a while
  gait_corrupt,    // frames with a wrong checksum, doubled or reordered
  gait_restarted,  // the controller started anew
  gait_jump,       // odometry that no robot can walk
  fallen,
  lifted,
  panel_missing,
  clock_jump,  // the time leapt: the machine slept, or stood still
  output,      // a report could not be written or sent
  count,
};

/// "camera_missing" and so on; never null.
const char* to_string(Fault fault);

class FaultSet {
 public:
  void set(Fault fault, bool present = true) {
    const std::uint32_t bit = std::uint32_t{1} << static_cast<unsigned>(fault);
    bits_ = present ? bits_ | bit : bits_ & ~bit;
  }
  [[nodiscard]] bool has(Fault fault) const { return ((bits_ >> static_cast<unsigned>(fault)) & 1U) != 0; }
  [[nodiscard]] bool any() const { return bits_ != 0; }
  [[nodiscard]] std::uint32_t bits() const { return bits_; }

 private:
  std::uint32_t bits_ = 0;
};

}  // namespace touchline
