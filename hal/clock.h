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

 private:
  virtual MonotonicNs do_now() = 0;
};

}  // namespace touchline
