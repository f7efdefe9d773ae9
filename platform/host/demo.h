// SPDX-License-Identifier: Apache-2.0
// `touchline demo`: the robot's application on the simulator's devices, with a kidnap in the middle, and pictures of
// it.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace touchline::host {

struct DemoCommand {
  std::string output = "demo";  // folder for stages.png, field.png and summary.json
  std::uint64_t seed = 1;
  double seconds = 20.0;
  bool live = false;  // standard output is a terminal: one line that is written over
};

/// Status 1 when the pose was not found again after the kidnap. Throws HostError.
int run_demo(const DemoCommand& command, std::ostream& out);

}  // namespace touchline::host
