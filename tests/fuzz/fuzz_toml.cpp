// SPDX-License-Identifier: Apache-2.0
// Any text as the robot's file: it is read, or refused by a HostError; nothing else.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "platform/host/host_error.h"
#include "platform/sbc/robot_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (text.find("replay") != std::string_view::npos) return 0;  // would read other folders of this machine
  static const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("touchline_fuzz_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path, std::ios::binary) << text;
  try {
    (void)touchline::sbc::read_robot_file(path);
  } catch (const touchline::host::HostError&) {
  }
  return 0;
}
