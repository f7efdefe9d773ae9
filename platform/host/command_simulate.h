// SPDX-License-Identifier: Apache-2.0
// `touchline simulate`: writes simulated frames as a data set, with exact truth.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace touchline::host {

struct SimulateCommand {
  std::string out;                     // folder to create
  std::string kind = "walk";           // walk: one run with odometry; poses: single pictures, each from nothing
  std::string field = "acyut-5x3";     // a preset
  std::string camera = "fisheye-185";  // fisheye-185, fisheye-140, fisheye-140-kb
  std::uint64_t seed = 1;
  double seconds = 5.0;             // walk
  double frames_per_second = 12.0;  // walk
  int count = 20;                   // poses
  bool yaw = true;                  // the robot has an IMU
  double kidnap_at_s = -1.0;        // walk; < 0: none
  int jpeg_quality = 0;             // 0: PNG
};

/// Throws HostError. Prints one line when done.
int run_simulate(const SimulateCommand& command, std::ostream& out);

}  // namespace touchline::host
