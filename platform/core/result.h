// SPDX-License-Identifier: Apache-2.0
// A value or the reason why there is none. Trivial types only, so that no destructor has to run.
#pragma once

#include "platform/core/status.h"

namespace touchline {

template <typename T>
class [[nodiscard]] Result {
 public:
  constexpr Result(const T& value) : value_(value), status_(Status::ok) {}  // NOLINT: implicit by intent
  constexpr Result(Status status) : value_{}, status_(status) {}            // NOLINT: implicit by intent

  [[nodiscard]] constexpr bool ok() const { return status_ == Status::ok; }
  [[nodiscard]] constexpr Status status() const { return status_; }
  /// Only meaningful when ok(); a default value otherwise.
  [[nodiscard]] constexpr const T& value() const { return value_; }

 private:
  T value_;
  Status status_;
};

}  // namespace touchline
