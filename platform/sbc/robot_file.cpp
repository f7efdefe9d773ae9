// SPDX-License-Identifier: Apache-2.0
// The robot's file as a whole, and the tables that are about the program and no device.
#include "platform/sbc/robot_file.h"

#include <map>

#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"
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
  if (!file.output.standard_output && file.output.udp.empty()) {
    file.notes.emplace_back("[output] stdout = false and no udp: the poses go nowhere");
  }
}

void read_realtime(KeyReader table, RobotFile& file) {
  RealtimeConfig& config = file.realtime;
  config.lock_memory = table.flag("lock_memory", config.lock_memory);
  config.priority = table.integer("priority", 0, 99, config.priority);
  config.cpu = table.integer("cpu", -1, 1023, config.cpu);
  table.finish();
}

namespace {

/// The first mistake of each table, so that not every one takes a run of its own.
class Mistakes {
 public:
  template <typename Read>
  void in(Read&& read) {
    try {
      read();
    } catch (const host::HostError& error) {
      text_.append(text_.empty() ? "" : "\n").append(error.what());
    }
  }
  void tell() const {
    if (!text_.empty()) throw host::HostError(text_);
  }

 private:
  std::string text_;
};

RobotFile read_tables(KeyReader& top, const std::filesystem::path& folder) {
  RobotFile file;
  Mistakes mistakes;
  // The camera first: a replayed set brings field, lens and mount along, and without it they cannot be judged.
  read_camera(top.inner("camera"), file, folder);
  mistakes.in([&] { read_field(top, file); });
  mistakes.in([&] { read_lens(top.inner("lens"), file); });
  mistakes.in([&] { read_mount(top.inner("mount"), file); });
  mistakes.in([&] { read_imu(top.inner("imu"), file); });
  mistakes.in([&] { read_gait(top.inner("gait"), file); });
  mistakes.in([&] { read_panel(top.inner("panel"), file, folder); });
  mistakes.in([&] { read_vision(top.inner("vision"), file); });
  mistakes.in([&] { read_localization(top.inner("localization"), file); });
  mistakes.in([&] { read_output(top.inner("output"), file); });
  mistakes.in([&] { read_realtime(top.inner("realtime"), file); });
  mistakes.in([&] { top.finish(); });
  mistakes.tell();
  return file;
}

/// Every key that a robot's file may have. The lens's centre has a second name, as in a data set, which is asked for
/// where it is given alone.
host::KeyLog all_keys() {
  host::KeyLog keys;
  nlohmann::json second_names;
  second_names["lens"] = {{"cx", 320.0}, {"cy", 240.0}};
  KeyReader top(second_names, {}, "", &keys);
  (void)read_tables(top, "");
  return keys;
}

/// The text of each part of the file that is read at the start alone.
std::map<std::string, std::string> fixed_parts(const nlohmann::json& root) {
  std::map<std::string, std::string> parts;
  const auto text = [](const nlohmann::json& value) {
    return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  };
  for (const auto& [name, value] : root.items()) {
    if (name != "vision" && name != "localization") parts["[" + name + "]"] = text(value);
  }
  for (const char* key : {"prior", "seed"}) {
    const auto localization = root.find("localization");
    if (localization != root.end() && localization->contains(key)) {
      parts[std::string("[localization] ") + key] = text((*localization)[key]);
    }
  }
  return parts;
}

}  // namespace

RobotFile read_robot_file(const std::filesystem::path& path, std::vector<std::string>* keys) {
  host::TomlLines lines;
  const nlohmann::json root = host::read_toml(path, "give the path of the robot's TOML file", lines);
  const host::KeyLog everything = all_keys();
  KeyReader top(root, {path.string(), 0, &lines, &everything}, "", keys);
  RobotFile file = read_tables(top, path.parent_path());
  file.fixed_parts = fixed_parts(root);
  return file;
}

}  // namespace touchline::sbc
