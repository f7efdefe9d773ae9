// SPDX-License-Identifier: Apache-2.0
// Few log lines worth reading: a line when a fault comes and when it has gone, at most ten in ten seconds; what was
// left out is counted in the next line.
#pragma once

#include <cstdint>
#include <string_view>

#include "platform/robot/robot_report.h"

namespace touchline::sbc {

class FaultLog {
 public:
  explicit FaultLog(int descriptor) : descriptor_(descriptor) {}

  /// `detail(fault)` is a sentence about it, or empty.
  template <typename Detail>
  void update(const FaultSet& faults, MonotonicNs now, const Detail& detail) {
    for (unsigned i = 0; i < static_cast<unsigned>(Fault::count); ++i) {
      const auto fault = static_cast<Fault>(i);
      if (faults.has(fault) == before_.has(fault)) continue;
      if (faults.has(fault)) {
        line(now, "fault: ", to_string(fault), detail(fault));
      } else {
        line(now, "well again: ", to_string(fault), "");
      }
    }
    before_ = faults;
  }
  /// Any other line; under the same limit.
  void line(MonotonicNs now, std::string_view what, std::string_view subject, std::string_view detail);

 private:
  static constexpr int burst = 10;
  static constexpr MonotonicNs period = 10 * one_second;

  int descriptor_;
  FaultSet before_;
  MonotonicNs window_ = 0;
  bool started_ = false;
  int in_window_ = 0;
  std::uint32_t left_out_ = 0;
};

}  // namespace touchline::sbc
