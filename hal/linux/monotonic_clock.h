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
  void do_wait_until(MonotonicNs time) override {
    timespec until{};
    until.tv_sec = static_cast<decltype(until.tv_sec)>(time / one_second);
    until.tv_nsec = static_cast<decltype(until.tv_nsec)>(time % one_second);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
  }
};

}  // namespace touchline
