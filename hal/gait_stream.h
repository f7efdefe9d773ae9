// SPDX-License-Identifier: Apache-2.0
// The order of gait frames: lost, doubled, reordered ones, a controller that restarted, and the controller's time
// brought to the local clock. The caller says when the bytes arrived.
#pragma once

#include <cstdint>

#include "hal/device_health.h"
#include "hal/gait_codec.h"

namespace touchline {

/// The controller's clock seen from here. A frame arrives its transport time late, sometimes later, never earlier: the
/// smallest difference seen is the best. It may creep, since two quartzes differ.
class ControllerClock {
 public:
  /// Local time at which the controller's clock stood at `controller_us`, given that news of it arrived at `arrival`.
  MonotonicNs to_local(std::uint32_t controller_us, MonotonicNs arrival);
  void reset() { started_ = false; }

 private:
  void follow(MonotonicNs seen);

  bool started_ = false;
  std::uint32_t last_us_ = 0;
  MonotonicNs controller_ = 0;   // the controller's time without wrapping, ns
  MonotonicNs offset_ = 0;       // local minus controller
  std::uint32_t late_ = 0;       // frames in a row that came so late that the controller may have stood still
  MonotonicNs late_offset_ = 0;  // the smallest difference among them
  MonotonicNs last_local_ = 0;   // what was answered last: answers grow
};

class GaitStream {
 public:
  /// `transport` is the least time from the sample to its last byte here; 44 bytes at 115200 baud: 3.8 ms.
  explicit GaitStream(MonotonicNs transport = 0) : transport_(transport) {}

  /// One byte from the line, that arrived at `arrival`.
  /// ok: it completed a sample that is to be used. not_ready: no sample. corrupt, unsupported: a damaged frame ended.
  /// stale: a frame ended that was doubled or came after a newer one.
  Result<GaitSample> push(std::uint8_t byte, MonotonicNs arrival);
  /// After the port was opened anew: the line may be in the middle of a frame; the controller is still the same.
  void line_reset() { decoder_.reset(); }

  /// received, lost, corrupt, stale, restarts and last_datum are counted here.
  [[nodiscard]] const DeviceHealth& counts() const { return counts_; }

 private:
  Result<GaitSample> accept(const GaitFrame& frame, MonotonicNs arrival);
  bool is_restart(const GaitSample& sample);

  GaitDecoder decoder_;
  ControllerClock clock_;
  MonotonicNs transport_;
  bool has_last_ = false;
  std::uint32_t last_sequence_ = 0;
  std::uint32_t boot_id_ = 0;
  std::uint32_t boot_id_before_ = 0;
  bool has_boot_before_ = false;
  std::uint32_t frames_of_old_boot_ = 0;
  DeviceHealth counts_;
};

}  // namespace touchline
