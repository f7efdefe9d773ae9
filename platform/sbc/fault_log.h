// SPDX-License-Identifier: Apache-2.0
// Few log lines worth reading: a line when a fault comes and when it has gone, at most ten in ten seconds; what was
// left out is counted in the next line, and a state that still differs from what was told last is told later.
#pragma once

#include <cstdint>
#include <string_view>

#include "platform/robot/robot_report.h"
#include "platform/sbc/line_writer.h"

namespace touchline::sbc {

class FaultLog {
 public:
  explicit FaultLog(int descriptor) : writer_(descriptor) {}

  /// `detail(fault)` is a sentence about it, or empty. No recovery is told whose fault was not.
  template <typename Detail>
  void update(const FaultSet& faults, MonotonicNs now, const Detail& detail) {
    for (unsigned i = 0; i < static_cast<unsigned>(Fault::count); ++i) {
      const auto fault = static_cast<Fault>(i);
      const bool changed = faults.has(fault) != before_.has(fault);
      if (faults.has(fault) == told_.has(fault)) {
        if (changed) ++left_out_;  // it was away, or there, for a moment that nobody was told of
        continue;
      }
      if (!has_room(now)) {
        if (changed) ++left_out_;
        continue;
      }
      told_.set(fault, faults.has(fault));
      if (!changed && left_out_ > 0) --left_out_;  // told late
      if (faults.has(fault)) {
        say("fault: ", to_string(fault), detail(fault));
      } else {
        say("well again: ", to_string(fault), "");
      }
    }
    before_ = faults;
  }
  /// Any other line. What the operator asked for is answered, however many lines there were before.
  void say(std::string_view what, std::string_view subject, std::string_view detail);

 private:
  static constexpr int burst = 10;
  static constexpr MonotonicNs period = 10 * one_second;

  bool has_room(MonotonicNs now);

  LineWriter writer_;
  FaultSet before_;  // as it was in the update before
  FaultSet told_;    // as the log's reader knows it
  MonotonicNs window_ = 0;
  bool started_ = false;
  int in_window_ = 0;
  std::uint32_t left_out_ = 0;
};

}  // namespace touchline::sbc
