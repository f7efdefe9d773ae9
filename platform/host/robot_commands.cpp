// SPDX-License-Identifier: Apache-2.0
#include "platform/host/robot_commands.h"

#include <ostream>

#include "platform/sbc/commands.h"

namespace touchline::host {

int run_robot(const RobotCommand& command, std::ostream& out, std::ostream& err) {
  out << std::flush;  // the daemon writes to the descriptor itself
  return sbc::run_robot({command.file, command.frames}, err);
}
int check_robot(const RobotCommand& command, std::ostream& out) { return sbc::check_robot(command.file, out); }
int list_devices(std::ostream& out) { return sbc::list_devices(out); }

}  // namespace touchline::host
