// SPDX-License-Identifier: Apache-2.0
// The link to the gait controller: odometry and the camera's attitude, as the walking engine knows them.
#pragma once

#include <cstdint>

#include "hal/device_health.h"
#include "platform/core/geometry.h"
#include "platform/core/result.h"
#include "platform/core/time.h"

namespace touchline {

enum class SupportFoot : std::uint8_t { unknown, left, right, both };

struct GaitSample {
  MonotonicNs time = 0;        // of the local clock: when the controller took the sample
  std::uint32_t sequence = 0;  // of the controller; a gap means lost samples
  std::uint32_t boot_id = 0;   // another number: the controller has restarted and `odometry` starts anew
  Pose2 odometry;  // robot now, in the robot's frame at boot: steps summed, so that a lost sample loses no step

  bool has_camera_attitude = false;  // the controller knows height, pitch and roll of the camera
  float camera_height = 0.0F;        // metres above the carpet
  float camera_pitch = 0.0F;         // radians, > 0 looks down
  float camera_roll = 0.0F;          // radians, > 0 lowers the right side
  bool has_head = false;             // the head's joints are known
  float head_pan = 0.0F;             // radians, > 0 looks left
  float head_tilt = 0.0F;            // radians, > 0 looks down

  SupportFoot support = SupportFoot::unknown;
  bool walking = false;
  bool standing = false;
  bool fallen = false;
  bool lifted = false;
};

/// Not thread safe. read() never blocks and never allocates.
class GaitLink {
 public:
  virtual ~GaitLink() = default;

  /// Already open: ok. disconnected: no such port (yet). device_error: the system refused.
  Status open() { return do_open(); }
  void close() { do_close(); }

  /// The oldest sample not read yet; call until it says not_ready. Damaged, doubled and reordered frames are counted
  /// and never returned.
  /// not_ready: nothing new. disconnected: not open or gone. device_error: the system refused.
  /// end_of_data: a recording is over.
  Result<GaitSample> read() { return do_read(); }

  [[nodiscard]] DeviceHealth health() const { return do_health(); }

 private:
  virtual Status do_open() = 0;
  virtual void do_close() = 0;
  virtual Result<GaitSample> do_read() = 0;
  virtual DeviceHealth do_health() const = 0;
};

}  // namespace touchline
