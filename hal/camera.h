// SPDX-License-Identifier: Apache-2.0
// A camera that lends its buffers: frames are read in place, nothing is copied.
#pragma once

#include <cstdint>

#include "hal/device_health.h"
#include "platform/core/frame.h"
#include "platform/core/result.h"
#include "platform/core/time.h"

namespace touchline {

struct CameraFrame {
  FrameView image;             // valid until release()
  MonotonicNs time = 0;        // when the frame was taken, as the driver stamps it (the camera's delay is the caller's)
  std::uint64_t sequence = 0;  // counts frames of the device, also those that were lost
  std::uint32_t lost = 0;      // frames the device lost between the frame before and this one
  std::uint32_t skipped = 0;   // older frames that waited and were passed over for this one
  bool error = false;          // the driver flags the content as damaged: release it, do not use it
  std::uint32_t buffer = 0;    // the backend's name for the buffer
};

/// Not thread safe. All calls but open() return within their deadline and allocate nothing for native pixel formats.
class Camera {
 public:
  virtual ~Camera() = default;

  /// Opens and starts streaming. Already open: ok, and nothing changes.
  /// disconnected: no such device (yet). unsupported: format or size not offered. device_error: the system refused.
  Status open() { return do_open(); }
  /// Stops and gives everything back; frames still held become void. Closing twice is allowed.
  void close() { do_close(); }

  /// Waits for a frame until `deadline` (of the clock; in the past: looks once) and lends the newest one.
  /// timeout: none came. disconnected: not open or gone; open() may bring it back. capacity: every buffer is lent.
  /// device_error: the system refused. end_of_data: a recording is over. wrong_size: not the configured size.
  Result<CameraFrame> acquire(MonotonicNs deadline) { return do_acquire(deadline); }
  /// Gives the buffer back. invalid_argument: that buffer is not lent. disconnected: gone; the frame is void anyway.
  Status release(const CameraFrame& frame) { return do_release(frame); }

  [[nodiscard]] DeviceHealth health() const { return do_health(); }

 private:
  virtual Status do_open() = 0;
  virtual void do_close() = 0;
  virtual Result<CameraFrame> do_acquire(MonotonicNs deadline) = 0;
  virtual Status do_release(const CameraFrame& frame) = 0;
  virtual DeviceHealth do_health() const = 0;
};

}  // namespace touchline
