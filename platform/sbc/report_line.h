// SPDX-License-Identifier: Apache-2.0
// A report as one line of JSON, schema version 1, written without the heap. The fields are described in
// platform/sbc/README.md.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "platform/robot/robot_report.h"

namespace touchline::sbc {

inline constexpr int report_schema_version = 1;

class ReportLine {
 public:
  /// The line with its newline; valid until the next call. The longest report there can be fits.
  std::string_view format(const RobotReport& report);

 private:
  /// One datagram without fragments, and one undivided write to a pipe, hold 4096 bytes of a line at the most.
  static constexpr std::size_t capacity = 4096;

  [[gnu::format(printf, 2, 3)]] void add(const char* format, ...);
  void add_number(double value, int digits);
  void add_pose(const Pose2& pose);
  void add_estimate(const PoseEstimate& estimate);
  void add_faults(const FaultSet& faults);
  void add_health(const char* name, const DeviceHealth& health, MonotonicNs now);

  std::array<char, capacity> text_{};
  std::size_t size_ = 0;
};

}  // namespace touchline::sbc
