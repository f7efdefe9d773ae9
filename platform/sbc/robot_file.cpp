// SPDX-License-Identifier: Apache-2.0
// The robot's file as a whole, and the tables that are about the program and no device.
#include "platform/sbc/robot_file.h"

#include <nlohmann/json.hpp>

#include "platform/host/toml_file.h"
#include "platform/sbc/robot_file_tables.h"
#include "platform/sbc/udp_address.h"

namespace touchline::sbc {

void read_output(KeyReader table, RobotFile& file) {
  file.output.standard_output = table.flag("stdout", file.output.standard_output);
  file.output.udp = table.texts("udp");
  for (const std::string& address : file.output.udp) {
    UdpAddress parsed;
    const std::string wrong = parse_udp_address(address, parsed);
    if (!wrong.empty()) table.fail("udp", wrong);
  }
  table.finish();
}

void read_realtime(KeyReader table, RobotFile& file) {
  RealtimeConfig& config = file.realtime;
  config.lock_memory = table.flag("lock_memory", config.lock_memory);
  config.priority = table.integer("priority", 0, 99, config.priority);
  config.cpu = table.integer("cpu", -1, 1023, config.cpu);
  table.finish();
}

RobotFile read_robot_file(const std::filesystem::path& path, std::vector<std::string>* keys) {
  host::TomlLines lines;
  const nlohmann::json root = host::read_toml(path, "give the path of the robot's TOML file", lines);
  KeyReader top(root, {path.string(), 0, &lines}, "", keys);
  RobotFile file;
  read_camera(top.inner("camera"), file,
              path.parent_path());  // first: a replayed set brings field, lens and mount along
  read_field(top, file);
  read_lens(top.inner("lens"), file);
  read_mount(top.inner("mount"), file);
  read_imu(top.inner("imu"), file);
  read_gait(top.inner("gait"), file);
  read_panel(top.inner("panel"), file, path.parent_path());
  read_vision(top.inner("vision"), file);
  read_localization(top.inner("localization"), file);
  read_output(top.inner("output"), file);
  read_realtime(top.inner("realtime"), file);
  top.finish();
  return file;
}

}  // namespace touchline::sbc
