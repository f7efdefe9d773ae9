// SPDX-License-Identifier: Apache-2.0
// What a device tells about itself: counts since the program started, and the last thing that went wrong.
#pragma once

#include <cstdint>

#include "platform/core/status.h"
#include "platform/core/time.h"

namespace touchline {

struct DeviceHealth {
  bool open = false;
  Status last_error = Status::ok;  // of the last failure; stays after recovery
  MonotonicNs last_datum = 0;      // time of the newest good frame, sample or event; 0: none yet
  std::uint32_t opened = 0;        // successful open() calls: more than 1 means that the device came back
  std::uint32_t received = 0;      // good frames, samples, events
  std::uint32_t lost = 0;          // missing by their sequence numbers
  std::uint32_t skipped = 0;       // good, but older than another that waited; passed over
  std::uint32_t corrupt = 0;       // checksum, length, flag or value wrong; never used
  std::uint32_t stale = 0;         // doubled, reordered or too old; never used
  std::uint32_t restarts = 0;      // of the controller at the other end
  std::uint32_t jumps = 0;         // implausible changes; never used as motion
};

}  // namespace touchline
