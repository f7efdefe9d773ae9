// SPDX-License-Identifier: Apache-2.0
// What a public call says when it cannot do what it was asked. "Nothing seen" is no error: it is an empty result.
#pragma once

#include <cstdint>

namespace touchline {

// clang-format 14 takes the attribute for the start of an initialiser list.
// clang-format off
enum class [[nodiscard]] Status : std::uint8_t {
  ok,
  invalid_argument,  // a parameter is outside its documented range (NaN counts as outside)
  wrong_size,        // an image, buffer or report has another size than was configured
  not_ready,         // nothing has been configured or received yet
  timeout,           // the deadline passed; the device may still be there
  disconnected,      // the device is gone; reopening may help
  corrupt,           // a checksum, a length or a field is wrong; the datum was not used
  stale,             // the datum is older than allowed
  capacity,          // a fixed capacity is full; what fitted is valid
  unsupported,       // the device or the build does not offer this
  device_error,      // the operating system or the device refused
  end_of_data,       // a recording is over; nothing more will come
};
// clang-format on

/// English name of the status, for logs; never null.
const char* to_string(Status status);

}  // namespace touchline
