// SPDX-License-Identifier: Apache-2.0
// `touchline run`, `touchline check` and `touchline devices`. Exit status: 0 done, 2 bad input.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

namespace touchline::sbc {

struct RunCommand {
  std::string file;
  std::uint64_t frames = 0;  // end after so many; 0: never
};
/// Runs until SIGTERM, SIGINT, or the end of a recording. Throws host::HostError before the first frame only.
int run_robot(const RunCommand& command, std::ostream& err);

/// Reads the file, says what the robot would do and which defaults stand for the robot's own lens, mount and field;
/// opens no device. Throws host::HostError.
int check_robot(const std::string& file, std::ostream& out);

/// What is plugged in, with the names that the file wants.
int list_devices(std::ostream& out);

}  // namespace touchline::sbc
