// SPDX-License-Identifier: Apache-2.0
// The observer that takes the time of each stage.
#pragma once

#include <array>
#include <chrono>

#include "vision/stage.h"

namespace touchline::host {

inline constexpr std::size_t stage_count = static_cast<std::size_t>(Stage::count);
using StageTimes = std::array<double, stage_count>;  // microseconds

// NOLINTNEXTLINE(cppcoreguidelines-virtual-class-destructor): final, and never deleted through its base
class StageClock final : public StageObserver {
 public:
  /// Microseconds of each stage: the mean over its runs since the last clear().
  [[nodiscard]] StageTimes times() const {
    StageTimes out{};
    for (std::size_t i = 0; i < stage_count; ++i) out[i] = runs_[i] > 0 ? sum_[i] / runs_[i] : 0.0;
    return out;
  }
  void clear() { *this = StageClock(); }

 private:
  void do_begin(Stage stage) override { started_[static_cast<std::size_t>(stage)] = std::chrono::steady_clock::now(); }
  void do_end(Stage stage) override {
    const auto i = static_cast<std::size_t>(stage);
    sum_[i] += std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - started_[i]).count();
    ++runs_[i];
  }

  std::array<std::chrono::steady_clock::time_point, stage_count> started_{};
  StageTimes sum_{};
  std::array<int, stage_count> runs_{};
};

}  // namespace touchline::host
