// SPDX-License-Identifier: Apache-2.0
// A clock that stands still until a test moves it; waiting moves it at once.
#pragma once

#include <cassert>

#include "hal/clock.h"

namespace touchline {

class ManualClock final : public Clock {
 public:
  explicit ManualClock(MonotonicNs start = one_second) : now_(start) {}

  void advance(MonotonicNs by) {
    assert(by >= 0);
    now_ += by;
  }
  /// Moves on to `time`; a time that has passed changes nothing, since the clock is monotonic.
  void advance_to(MonotonicNs time) { now_ = time > now_ ? time : now_; }

 private:
  MonotonicNs do_now() override { return now_; }
  void do_wait_until(MonotonicNs time) override { advance_to(time); }

  MonotonicNs now_;
};

}  // namespace touchline
