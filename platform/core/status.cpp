// SPDX-License-Identifier: Apache-2.0
#include "platform/core/status.h"

namespace touchline {

const char* to_string(Status status) {
  switch (status) {
    case Status::ok: return "ok";
    case Status::invalid_argument: return "invalid argument";
    case Status::wrong_size: return "wrong size";
    case Status::not_ready: return "not ready";
    case Status::timeout: return "timeout";
    case Status::disconnected: return "disconnected";
    case Status::corrupt: return "corrupt";
    case Status::stale: return "stale";
    case Status::capacity: return "capacity exceeded";
    case Status::unsupported: return "unsupported";
    case Status::device_error: return "device error";
    case Status::end_of_data: return "end of data";
  }
  return "unknown status";
}

}  // namespace touchline
