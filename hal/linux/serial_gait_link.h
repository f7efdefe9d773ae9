// SPDX-License-Identifier: Apache-2.0
// The gait link on a serial port (termios): opens it raw and hands its bytes to the codec.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "hal/clock.h"
#include "hal/gait_link.h"
#include "hal/gait_stream.h"
#include "hal/linux/problem.h"

namespace touchline {

struct SerialGaitLinkConfig {
  std::string device = "/dev/ttyACM0";
  int baud = 115200;
  MonotonicNs transport = 4 * one_millisecond;  // least time from the sample to its last byte here
};

/// False for a rate that termios does not know.
bool is_known_baud(int baud);

class SerialGaitLink final : public GaitLink {
 public:
  SerialGaitLink(const SerialGaitLinkConfig& config, Clock& clock)
      : config_(config), clock_(clock), stream_(config.transport) {}
  ~SerialGaitLink() override { do_close(); }
  SerialGaitLink(const SerialGaitLink&) = delete;
  SerialGaitLink& operator=(const SerialGaitLink&) = delete;

  [[nodiscard]] const char* problem() const { return problem_.text(); }
  /// Why there are no frames, as far as that can be told from here: no bytes at all, or bytes that are no frame.
  [[nodiscard]] const char* silence() const;

 private:
  /// What the kernel's tty buffer hands over at most in one read.
  static constexpr std::size_t chunk = 4096;
  /// Noise without a sample ends a read() after this many chunks, so that a babbling line cannot hold the loop.
  static constexpr int max_chunks = 4;

  Status do_open() override;
  void do_close() override;
  Result<GaitSample> do_read() override;
  DeviceHealth do_health() const override;

  Status fail(Status status, const char* what);
  Status configure_port();
  Status refill();

  SerialGaitLinkConfig config_;
  Clock& clock_;
  GaitStream stream_;
  Problem problem_;
  Status last_error_ = Status::ok;
  std::uint32_t opened_ = 0;
  int descriptor_ = -1;
  std::array<std::uint8_t, chunk> bytes_{};
  std::size_t size_ = 0;
  std::size_t next_ = 0;
  MonotonicNs arrival_ = 0;
  MonotonicNs framed_ = 0;  // arrival of the bytes that held the newest frame, or the opening
};

}  // namespace touchline
