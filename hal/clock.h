// SPDX-License-Identifier: Apache-2.0
// The clock as a device, so that tests, replays and the simulator set the time. Every time stamp of hal is in its base.
#pragma once

#include "platform/core/time.h"

namespace touchline {

class Clock {
 public:
  virtual ~Clock() = default;

  /// Never smaller than what an earlier call returned. Cannot fail.
  [[nodiscard]] MonotonicNs now() { return do_now(); }
  /// Returns once `time` has come, at once when it has passed; a signal may end it early.
  void wait_until(MonotonicNs time) { do_wait_until(time); }

 private:
  virtual MonotonicNs do_now() = 0;
  virtual void do_wait_until(MonotonicNs time) = 0;
};

}  // namespace touchline
