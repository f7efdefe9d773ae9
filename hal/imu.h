// SPDX-License-Identifier: Apache-2.0
// An inertial unit that reports an orientation; yaw is what localization needs most.
#pragma once

#include "hal/device_health.h"
#include "platform/core/result.h"
#include "platform/core/time.h"

namespace touchline {

/// Angles of the torso in radians: yaw grows counter-clockwise, pitch > 0 bows forward, roll > 0 lowers the right side.
struct ImuSample {
  MonotonicNs time = 0;
  float yaw = 0.0F;  // unwrapped: continuous over full turns; its zero is arbitrary
  bool has_tilt = false;
  float roll = 0.0F;   // void without has_tilt
  float pitch = 0.0F;  // likewise
  bool has_yaw_rate = false;
  float yaw_rate = 0.0F;  // rad/s; void without has_yaw_rate
};

/// Not thread safe. read() never blocks and never allocates.
class Imu {
 public:
  virtual ~Imu() = default;

  /// Already open: ok. disconnected: no such device (yet). unsupported: it has not the reports that the config names.
  /// device_error: the system refused.
  Status open() { return do_open(); }
  void close() { do_close(); }

  /// The oldest sample not read yet; call until it says not_ready. Damaged reports are counted and never returned.
  /// not_ready: nothing new. disconnected: not open or gone. device_error: the system refused.
  /// end_of_data: a recording is over.
  Result<ImuSample> read() { return do_read(); }

  [[nodiscard]] DeviceHealth health() const { return do_health(); }

 private:
  virtual Status do_open() = 0;
  virtual void do_close() = 0;
  virtual Result<ImuSample> do_read() = 0;
  virtual DeviceHealth do_health() const = 0;
};

}  // namespace touchline
