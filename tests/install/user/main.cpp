// SPDX-License-Identifier: Apache-2.0
// A user's first program, built by the install test.
#include <cstdio>

#include "platform/core/static_vector.h"
#include "platform/core/status.h"

int main() {
  touchline::StaticVector<int, 4> numbers;
  numbers.push_back(1);
  std::printf("touchline says: %s, %zu\n", touchline::to_string(touchline::Status::ok), numbers.size());
}
