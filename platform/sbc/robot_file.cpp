// SPDX-License-Identifier: Apache-2.0
// The robot's file as a whole, and the tables that are about the program and no device.
#include "platform/sbc/robot_file.h"

#include <fstream>

#include "platform/host/host_error.h"
#include "platform/sbc/robot_file_tables.h"

namespace touchline::sbc {
namespace {

toml::table parse(const std::filesystem::path& path) {
  std::error_code unknown;  // then the open below says why
  if (std::filesystem::is_directory(path, unknown))
    throw host::HostError(path.string() + ": is a folder; name the robot's TOML file");
  if (!std::ifstream(path))
    throw host::HostError(path.string() + ": cannot be read; give the path of the robot's TOML file");
  try {
    return toml::parse_file(path.string());
  } catch (const toml::parse_error& error) {
    throw host::HostError(path.string() + ":" + std::to_string(error.source().begin.line) +
                          ": is no TOML: " + std::string(error.description()));
  }
}

/// What only the parts together can say: the lens, the field and the chain check themselves.
void check_together(const std::string& name, const RobotFile& file) {
  const char* what = nullptr;
  Lens lens;
  if (Lens::create(file.robot.lens, lens, &what) != Status::ok) {
    throw host::HostError(name + ": [lens] is refused: " + (what != nullptr ? what : "its values do not fit together"));
  }
  Field field;
  if (Field::create(file.robot.field, field, &what) != Status::ok) {
    throw host::HostError(name +
                          ": [field] is refused: " + (what != nullptr ? what : "its values do not fit together"));
  }
}

}  // namespace

void read_output(TomlTable table, RobotFile& file) {
  file.output.standard_output = table.flag("stdout", file.output.standard_output);
  file.output.udp = table.texts("udp");
  table.finish();
}

void read_realtime(TomlTable table, RobotFile& file) {
  RealtimeConfig& config = file.realtime;
  config.lock_memory = table.flag("lock_memory", config.lock_memory);
  config.priority = table.integer("priority", 0, 99, config.priority);
  config.cpu = table.integer("cpu", -1, 1023, config.cpu);
  table.finish();
}

RobotFile read_robot_file(const std::filesystem::path& path, std::vector<std::string>* keys) {
  const toml::table document = parse(path);
  TomlTable top(&document, path.string(), "", keys);
  RobotFile file;
  read_camera(top.table("camera"), file,
              path.parent_path());  // first: a replayed set brings field, lens and mount along
  read_field(top.table("field"), file);
  read_lens(top.table("lens"), file);
  read_mount(top.table("mount"), file);
  read_imu(top.table("imu"), file);
  read_gait(top.table("gait"), file);
  read_panel(top.table("panel"), file, path.parent_path());
  read_vision(top.table("vision"), file);
  read_localization(top.table("localization"), file);
  read_output(top.table("output"), file);
  read_realtime(top.table("realtime"), file);
  top.finish();
  check_together(path.string(), file);
  return file;
}

}  // namespace touchline::sbc
