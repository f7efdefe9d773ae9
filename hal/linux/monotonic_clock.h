// SPDX-License-Identifier: Apache-2.0
// CLOCK_MONOTONIC: the base of the kernel's time stamps on camera buffers, untouched by settings of the time of day.
#pragma once

#include <ctime>

#include "hal/clock.h"

namespace touchline {

class MonotonicClock final : public Clock {
 private:
  MonotonicNs do_now() override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);  // cannot fail for this clock
    return MonotonicNs{now.tv_sec} * one_second + now.tv_nsec;
  }
};

}  // namespace touchline
