// SPDX-License-Identifier: Apache-2.0
// Any text as the frames of a data set: they are read, or refused by a HostError; nothing else.
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "platform/host/dataset.h"
#include "platform/host/host_error.h"

namespace {

std::filesystem::path make_folder() {
  const auto folder = std::filesystem::temp_directory_path() / ("touchline_fuzz_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "dataset.toml") << R"(name = "fuzz"
protocol = "sequence"
field = "acyut-5x3"
[camera]
width = 32
height = 24
model = "equidistant"
focal_px = 10.0
max_theta_deg = 80.0
[mount]
height_m = 0.5
)";
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = make_folder();
  std::ofstream(folder / "frames.jsonl", std::ios::binary)
      << std::string_view(reinterpret_cast<const char*>(data), size);
  try {
    (void)touchline::host::read_dataset(folder);
  } catch (const touchline::host::HostError&) {
  }
  return 0;
}
