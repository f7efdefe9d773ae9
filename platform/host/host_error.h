// SPDX-License-Identifier: Apache-2.0
// The one exception of the host programs: bad input or a bad command. Its text names the file, the key and the remedy;
// `touchline` prints it and exits with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace touchline::host {

class HostError : public std::runtime_error {
 public:
  explicit HostError(const std::string& text) : std::runtime_error(text) {}
};

}  // namespace touchline::host
