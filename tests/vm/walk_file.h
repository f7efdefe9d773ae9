// SPDX-License-Identifier: Apache-2.0
// A simulated walk as two files that a program without the simulator can play: walk.yuyv, the pictures one after the
// other, and walk.txt, a line per reading:  t_s x_m y_m theta yaw height pitch roll  and a line per picture: frame t_s
// x_m y_m theta  (its truth). Radians.
#pragma once

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "platform/core/geometry.h"

namespace touchline::vm {

struct WalkReading {
  double time_s = 0.0;
  Pose2 odometry;  // summed
  float yaw = 0, height = 0, pitch = 0, roll = 0;
};
struct WalkFrame {
  double time_s = 0.0;
  Pose2 truth;
};
struct Walk {
  std::vector<WalkReading> readings;
  std::vector<WalkFrame> frames;
};

inline Walk read_walk(const std::string& path) {
  Walk walk;
  std::ifstream in(path);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    if (line.starts_with("frame ")) {
      std::string word;
      WalkFrame frame;
      words >> word >> frame.time_s >> frame.truth.x >> frame.truth.y >> frame.truth.theta;
      walk.frames.push_back(frame);
    } else {
      WalkReading r;
      words >> r.time_s >> r.odometry.x >> r.odometry.y >> r.odometry.theta >> r.yaw >> r.height >> r.pitch >> r.roll;
      walk.readings.push_back(r);
    }
  }
  return walk;
}

}  // namespace touchline::vm
