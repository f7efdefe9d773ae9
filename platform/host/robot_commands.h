// SPDX-License-Identifier: Apache-2.0
// `touchline run`, `check` and `devices` as the command line sees them. Two implementations: robot_commands.cpp where
// the backends for real devices are built, robot_commands_none.cpp where they are not.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace touchline::host {

struct RobotCommand {
  std::string file;          // the robot's TOML file
  std::uint64_t frames = 0;  // run: end after so many; 0: never
};
int run_robot(const RobotCommand& command, std::ostream& out, std::ostream& err);
int check_robot(const RobotCommand& command, std::ostream& out);
int list_devices(std::ostream& out);

}  // namespace touchline::host
