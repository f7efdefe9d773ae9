// SPDX-License-Identifier: Apache-2.0
// Time that this thread had a processor: what else runs on the machine does not count. Both sides have one thread.
#pragma once

#include <time.h>

#include <algorithm>
#include <array>

#include "platform/host/stage_clock.h"
#include "vision/stage.h"

namespace touchline::bench {

inline double cpu_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

/// What the clock adds to whatever it takes the time of: a system call, half a microsecond. It is taken off from both
/// sides' steps, or the side with the shorter ones would pay more for it.
inline double clock_cost_us() {
  static const double cost = [] {
    std::array<double, 1001> empty{};
    for (double& us : empty) {
      const double begin = cpu_us();
      us = cpu_us() - begin;
    }
    std::nth_element(empty.begin(), empty.begin() + empty.size() / 2, empty.end());
    return empty[empty.size() / 2];
  }();
  return cost;
}

template <typename Step>
double timed(Step step) {
  const double cost = clock_cost_us();
  const double begin = cpu_us();
  step();
  return cpu_us() - begin - cost;
}

class CpuStageClock final : public StageObserver {
 public:
  [[nodiscard]] const host::StageTimes& times() const { return us_; }

 private:
  void do_begin(Stage stage) override { us_[static_cast<std::size_t>(stage)] -= cpu_us(); }
  void do_end(Stage stage) override { us_[static_cast<std::size_t>(stage)] += cpu_us() - cost_; }
  double cost_ = clock_cost_us();
  host::StageTimes us_{};
};

}  // namespace touchline::bench
