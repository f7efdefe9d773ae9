// SPDX-License-Identifier: Apache-2.0
// Where report lines go: a file descriptor (standard output) and UDP addresses. Never waits and never stops the robot:
// what cannot be written at once is dropped and counted.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "platform/sbc/line_writer.h"
#include "platform/sbc/udp_address.h"

namespace touchline::sbc {

class Publisher {
 public:
  /// `descriptor` < 0: none. Throws host::HostError for an address that is none.
  Publisher(int descriptor, const std::vector<std::string>& udp);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// False when the line did not reach some place.
  bool publish(std::string_view line);
  /// Lines that did not reach some place.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// errno of the last failure; 0: none yet. EAGAIN: the reader is too slow.
  [[nodiscard]] int last_error() const { return last_error_; }
  /// The place that failed last, and why: "standard output: No space left on device".
  [[nodiscard]] const char* problem() const { return problem_.data(); }
  /// Nobody reads the descriptor any more (a closed pipe). It stays a failure of every line.
  [[nodiscard]] bool closed() const { return writer_.closed(); }
  /// Lines that did not reach the descriptor, and errno of the last one.
  [[nodiscard]] std::uint64_t lines_lost() const { return lines_lost_; }
  [[nodiscard]] int line_error() const { return line_error_; }

 private:
  struct Target {
    int descriptor = -1;
    UdpAddress address;
    std::string text;
  };
  void note(const char* where, int error);

  LineWriter writer_;
  std::vector<Target> targets_;
  std::uint64_t dropped_ = 0;
  std::uint64_t lines_lost_ = 0;
  int line_error_ = 0;
  int last_error_ = 0;
  std::array<char, 160> problem_{};
};

}  // namespace touchline::sbc
