// SPDX-License-Identifier: Apache-2.0
// `touchline locate`: single images, each from nothing. What the robot knew about an image comes from its options, else
// from its line in the frames.jsonl beside dataset.toml, else from dataset.toml.
#include <map>
#include <ostream>

#include "platform/host/command_line.h"
#include "platform/host/frame_pictures.h"
#include "platform/host/host_error.h"
#include "platform/host/report.h"
#include "platform/host/run_set.h"

namespace touchline::host {
namespace {

float as_radians(double degrees) { return radians(static_cast<float>(degrees)); }

std::string one_name(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto name = std::filesystem::weakly_canonical(path, ignored);
  return (name.empty() ? path : name).string();
}

/// dataset.toml, with the frames beside it where it has some.
DataSet read_camera_file(const std::filesystem::path& given) {
  const bool is_folder = std::filesystem::is_directory(given);
  const std::filesystem::path file = is_folder ? given / "dataset.toml" : given;
  const bool has_frames =
      file.filename() == "dataset.toml" && std::filesystem::exists(file.parent_path() / "frames.jsonl");
  if (!has_frames) return read_dataset_toml(file);
  return read_dataset(file.parent_path().empty() ? std::filesystem::path(".") : file.parent_path());
}

/// The options that say what a line of frames.jsonl says, too; nothing when none is given.
std::string overriding(const LocateCommand& command) {
  std::string text;
  const auto add = [&text](const char* what, const std::optional<double>& given) {
    if (given) text += (text.empty() ? "" : ", ") + std::string(what);
  };
  add("--height-m", command.height_m);
  add("--pitch-deg", command.pitch_deg);
  add("--roll-deg", command.roll_deg);
  add("--yaw-deg", command.yaw_deg);
  return text;
}

void apply_options(const LocateCommand& command, const DataSet& set, DataFrame& frame) {
  CameraPose& mount = frame.camera.mount;
  if (command.height_m) mount.height = static_cast<float>(*command.height_m);
  if (command.pitch_deg) mount.pitch = as_radians(*command.pitch_deg);
  if (command.roll_deg) mount.roll = as_radians(*command.roll_deg);
  if (command.yaw_deg) {
    frame.has_yaw = true;
    frame.yaw = wrap_angle(as_radians(*command.yaw_deg - set.goal_yaw_deg));
  }
  if (!overriding(command).empty()) frame.has_truth = false;  // it is the truth of another mount
  if (!(mount.height > 0.0F)) {
    throw HostError(command.camera + ": [mount] height_m: is missing; add it, or give --height-m");
  }
}

void print_sources(const LocateCommand& command, int found, std::ostream& out) {
  const std::string options = overriding(command);
  out << found << " of " << command.images.size() << " images have a line in frames.jsonl; ";
  if (options.empty()) {
    out << "mount, yaw and truth are taken from there\n";
  } else {
    out << "the rest of mount and yaw is taken from there, but " << options
        << " is as you gave it, and poses are not held against a truth\n";
  }
}

}  // namespace

int run_locate(const LocateCommand& command, std::ostream& out, std::ostream& err) {
  DataSet set = read_camera_file(command.camera);
  print_warnings(set, err);
  std::map<std::string, DataFrame> listed;
  for (const auto& frame : set.frames) listed.emplace(one_name(frame.path), frame);
  set.protocol = Protocol::independent;
  set.frames.clear();
  int found = 0;
  for (const auto& image : command.images) {
    DataFrame frame;
    frame.camera = set.camera;
    const auto entry = listed.find(one_name(image));
    if (entry != listed.end()) {
      frame = entry->second;
      ++found;
    }
    frame.image = image;
    frame.path = image;
    frame.line = 0;
    apply_options(command, set, frame);
    set.frames.push_back(frame);
  }
  refuse_to_overwrite({set}, command.options.frames_out);
  if (found > 0 && !command.json) print_sources(command, found, out);
  const SetResult result = run_set(set, command.options, command.json, out, err);
  if (command.json) out << json_summary({result}, command.options) << "\n";
  return exit_status({result});
}

}  // namespace touchline::host
