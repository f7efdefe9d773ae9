// SPDX-License-Identifier: Apache-2.0
#include "platform/host/host_error.h"
#include "platform/host/robot_commands.h"

namespace touchline::host {
namespace {

[[noreturn]] void refuse() {
  throw HostError(
      "this program was built without backends for real devices; install libv4l-dev, libhidapi-dev and libgpiod-dev "
      "and "
      "build with -DTOUCHLINE_BACKENDS=ON");
}

}  // namespace

int run_robot(const RobotCommand&, std::ostream&, std::ostream&) { refuse(); }
int check_robot(const RobotCommand&, std::ostream&) { refuse(); }
int list_devices(std::ostream&) { refuse(); }

}  // namespace touchline::host
