// SPDX-License-Identifier: Apache-2.0
// Faults that are events and not states: each is shown for a while after it happened.
#pragma once

#include <array>
#include <cstddef>

#include "platform/core/time.h"
#include "platform/robot/fault.h"

namespace touchline {

class EventFaults {
 public:
  void note(Fault fault, MonotonicNs now) { until_[static_cast<std::size_t>(fault)] = now + hold_; }
  void set_hold(MonotonicNs hold) { hold_ = hold; }
  void add_to(FaultSet& faults, MonotonicNs now) const {
    for (std::size_t i = 0; i < until_.size(); ++i) {
      if (until_[i] > now) faults.set(static_cast<Fault>(i));
    }
  }

 private:
  std::array<MonotonicNs, static_cast<std::size_t>(Fault::count)> until_{};
  MonotonicNs hold_ = 2 * one_second;
};

/// When a device that is missing is to be tried next.
class Retry {
 public:
  /// True once a period, at once the first time.
  bool due(MonotonicNs now, MonotonicNs period) {
    if (tried_ && now - last_ < period) return false;
    tried_ = true;
    last_ = now;
    return true;
  }

 private:
  bool tried_ = false;
  MonotonicNs last_ = 0;
};

}  // namespace touchline
