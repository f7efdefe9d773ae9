// SPDX-License-Identifier: Apache-2.0
// Time that this thread had a processor: what else runs on the machine does not count. Both sides have one thread.
#pragma once

#include <time.h>

#include <array>

#include "platform/host/stage_clock.h"
#include "vision/stage.h"

namespace touchline::bench {

inline double cpu_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

template <typename Step>
double timed(Step step) {
  const double begin = cpu_us();
  step();
  return cpu_us() - begin;
}

class CpuStageClock final : public StageObserver {
 public:
  [[nodiscard]] const host::StageTimes& times() const { return us_; }

 private:
  void do_begin(Stage stage) override { us_[static_cast<std::size_t>(stage)] -= cpu_us(); }
  void do_end(Stage stage) override { us_[static_cast<std::size_t>(stage)] += cpu_us(); }
  host::StageTimes us_{};
};

}  // namespace touchline::bench
