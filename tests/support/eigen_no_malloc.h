// SPDX-License-Identifier: Apache-2.0
// Comes before Eigen in every source of touchline_loc_checked and of the tests that link it (by -include): Eigen then
// checks on each allocation whether one is allowed, and ends the program where not, in Release builds too.
#pragma once

#include <cstdio>
#include <cstdlib>

#define EIGEN_RUNTIME_NO_MALLOC

namespace touchline::test {
[[noreturn]] inline void eigen_assertion_failed(const char* text, const char* file, int line) {
  std::fprintf(stderr, "%s:%d: Eigen's assertion failed: %s\n", file, line, text);
  std::_Exit(1);
}
}  // namespace touchline::test

#define eigen_assert(condition) \
  ((condition) ? static_cast<void>(0) : touchline::test::eigen_assertion_failed(#condition, __FILE__, __LINE__))
