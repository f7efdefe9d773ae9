// SPDX-License-Identifier: Apache-2.0
// Where report lines go: a file descriptor (standard output) and UDP addresses. Never waits and never stops the robot:
// what cannot be written at once is dropped and counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <netinet/in.h>
#include <sys/socket.h>

namespace touchline::sbc {

/// Empty when "host:port" names a numeric address and a port, else what is wrong with it.
std::string udp_address_error(const std::string& address);

class Publisher {
 public:
  /// `descriptor` < 0: none. Throws host::HostError for an address that is none.
  Publisher(int descriptor, const std::vector<std::string>& udp);
  ~Publisher();
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  /// False when the line did not reach some place.
  bool publish(std::string_view line);
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }
  /// errno of the last failure; 0: none yet. EAGAIN: the reader is too slow.
  [[nodiscard]] int last_error() const { return last_error_; }
  /// Nobody reads any more (a closed pipe).
  [[nodiscard]] bool closed() const { return closed_; }

 private:
  struct Target {
    int descriptor = -1;
    sockaddr_storage address{};
    socklen_t size = 0;
  };
  bool write_line(std::string_view line);

  int descriptor_;
  bool closed_ = false;
  std::vector<Target> targets_;
  std::uint64_t dropped_ = 0;
  int last_error_ = 0;
};

}  // namespace touchline::sbc
