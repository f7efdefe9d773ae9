// SPDX-License-Identifier: Apache-2.0
// The exception of the host programs: bad input or a bad command. Its text names the file, the key and the remedy;
// `touchline` prints it and exits with status 2.
#pragma once

#include <stdexcept>
#include <string>

namespace touchline::host {

class HostError : public std::runtime_error {
 public:
  explicit HostError(const std::string& text) : std::runtime_error(text) {}
};

/// One frame of a data set cannot be used; the others can.
class FrameError : public HostError {
 public:
  using HostError::HostError;
};

}  // namespace touchline::host
