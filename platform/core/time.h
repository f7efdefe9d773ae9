// SPDX-License-Identifier: Apache-2.0
// One time base for everything: nanoseconds of a monotonic clock. The core only computes with times; it never asks for
// one.
#pragma once

#include <cstdint>

namespace touchline {

/// Nanoseconds of the monotonic clock; only differences mean something. 292 years fit.
using MonotonicNs = std::int64_t;

inline constexpr MonotonicNs one_millisecond = 1'000'000;
inline constexpr MonotonicNs one_second = 1'000'000'000;

constexpr double to_seconds(MonotonicNs time) { return static_cast<double>(time) * 1e-9; }
/// Rounded to the nearest nanosecond; |seconds| < 9e9.
constexpr MonotonicNs from_seconds(double seconds) {
  return static_cast<MonotonicNs>(seconds * 1e9 + (seconds < 0.0 ? -0.5 : 0.5));
}

}  // namespace touchline
