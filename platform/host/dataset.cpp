// SPDX-License-Identifier: Apache-2.0
// dataset.toml and frames.jsonl, key by key.
#include "platform/host/dataset.h"

#include <algorithm>
#include <optional>
#include <string_view>

#include <nlohmann/json.hpp>

#include "loc/localizer.h"
#include "platform/host/chain_tables.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "platform/host/input_file.h"
#include "platform/host/key_notes.h"
#include "platform/host/key_reader.h"
#include "platform/host/toml_file.h"

namespace touchline::host {
namespace {

using nlohmann::json;
constexpr double any_metres = 1000.0;  // a field is 14 m; more is a slip of units
constexpr double any_step_m = static_cast<double>(max_step_m);
constexpr std::size_t most_frames_bytes = std::size_t{1} << 30;  // a day of frames

float as_float(double value) { return static_cast<float>(value); }
float as_radians(double value) { return static_cast<float>(value * 3.14159265358979323846 / 180.0); }
float as_heading(double value) { return wrap_angle(as_radians(value)); }

/// Keys of another lens model: they would be left out in silence.
void tell_unused_lens_keys(const KeyReader& keys, const json& table, LensModel model, KeyNotes& notes,
                           const json* own) {
  for (const LensKeyOwner& entry : lens_key_owners) {
    if (entry.model == model || !table.contains(entry.key)) continue;
    notes.say(keys, entry.key,
              std::string("belongs to the model ") + entry.name + " and is not used; take it out, or change model",
              own);
  }
}

/// A principal point outside of the picture is a slip in nearly all cases: a crop that was forgotten, a sign.
void check_principal_point(const KeyReader& keys, const json& table, const CameraSetup& camera, KeyNotes& notes,
                           const json* own) {
  const float outside_u = std::max({0.0F, -camera.lens.cx, camera.lens.cx - static_cast<float>(camera.width)});
  const float outside_v = std::max({0.0F, -camera.lens.cy, camera.lens.cy - static_cast<float>(camera.height)});
  if (outside_u == 0.0F && outside_v == 0.0F) return;
  std::string key = outside_u > 0.0F ? "cx" : "cy";
  if (!table.contains(key)) key += "_px";
  const float value = outside_u > 0.0F ? camera.lens.cx : camera.lens.cy;
  const std::string what = "is " + json(static_cast<double>(value)).dump() + ", outside of the picture of " +
                           std::to_string(camera.width) + "x" + std::to_string(camera.height) + " pixels";
  Lens lens;
  const bool made = Lens::create(camera.lens, lens) == Status::ok;
  if (made && math::hypot(outside_u, outside_v) > lens.max_radius()) {
    keys.fail(key, what + ", and so far that the lens sees nothing there; count it from the picture's top left corner");
  }
  notes.say(keys, key, what + "; check it: it counts from the picture's top left corner", own);
}

/// Camera and mount of dataset.toml, or of a frame; then `own` holds the frame's own keys, the others were told before.
void read_camera(const json& table, const Place& place, CameraSetup& out, KeyNotes& notes, const json* own = nullptr) {
  KeyReader keys(table, place, "camera");
  keys.expect({"width", "height"});
  expect_lens_keys(keys);
  notes.add(keys, own);
  out.width = keys.integer("width", 16, max_frame_width, "give the images' width in pixels, at most 1280");
  out.height = keys.integer("height", 16, max_frame_height, "give the images' height in pixels, at most 1024");
  out.lens = {};
  out.lens.cx = as_float(out.width * 0.5);
  out.lens.cy = as_float(out.height * 0.5);
  read_lens(keys, false, out.lens);
  tell_unused_lens_keys(keys, table, out.lens.model, notes, own);
  check_principal_point(keys, table, out, notes, own);
}

/// `need_height` false: it may come later, and is 0 until then.
void read_mount_table(const json& table, const Place& place, bool need_height, CameraPose& out, KeyNotes& notes,
                      const json* own = nullptr) {
  KeyReader keys(table, place, "mount");
  expect_mount_keys(keys);
  notes.add(keys, own);
  out = {};
  read_mount(keys, !need_height, out);
}

Protocol read_protocol(KeyReader& keys) {
  return keys.choice("protocol", {"independent", "sequence"}, 0) == 0 ? Protocol::independent : Protocol::sequence;
}

/// What the frames need of dataset.toml beside the parsed values: the raw tables that a frame's keys are laid over.
struct TomlTables {
  json camera = json::object();
  json mount = json::object();
};

/// Also of ".", of "set/" and of a symbolic link's name in a path.
std::string name_of_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  auto path = std::filesystem::absolute(folder / "x", ignored).lexically_normal().parent_path();
  return path.filename().string();
}

void read_toml_part(const std::filesystem::path& file, TomlTables& tables, DataSet& out, KeyNotes& notes) {
  TomlLines lines;
  const json root = read_toml(file, "a data set is a folder with dataset.toml, frames.jsonl and images", lines);
  const Place place{file.string(), 0, &lines};
  KeyReader keys(root, place, "");
  keys.expect({"name", "protocol", "field", "camera", "mount", "imu"});
  notes.add(keys);
  out.folder = file.parent_path();
  out.name = keys.text("name", "");
  if (out.name.empty()) out.name = name_of_folder(out.folder);
  out.protocol = read_protocol(keys);
  const NamedField field = read_field(keys, std::nullopt, &notes);
  out.field_name = field.name;
  out.field = field.dimensions;
  if (!keys.has("camera")) keys.fail("camera", "is missing; write [camera], with the lens and the size of the images");
  tables.camera = keys.table("camera");
  tables.mount = keys.table("mount");
  read_camera(tables.camera, place, out.camera, notes);
  read_mount_table(tables.mount, place, false, out.camera.mount, notes);
  KeyReader imu = keys.inner("imu");
  imu.expect({"goal_yaw_deg"});
  notes.add(imu);
  out.goal_yaw_deg = imu.number("goal_yaw_deg", {-1e6, 1e6, "give the IMU's reading in degrees"}, 0.0);
}

Pose2 read_pose(KeyReader keys, const char* x, const char* y, const char* theta, double most_m, KeyNotes& notes,
                bool* kidnap) {
  keys.expect({x, y, theta});
  if (kidnap != nullptr) keys.expect({"kidnap"});
  notes.add(keys);
  const NumberRange metres{-most_m, most_m, "give it in metres"};
  const NumberRange angle{-1e6, 1e6, "give it in degrees"};
  Pose2 pose;
  pose.x = as_float(keys.number(x, metres));
  pose.y = as_float(keys.number(y, metres));
  pose.theta = as_heading(keys.number(theta, angle));
  if (kidnap != nullptr) *kidnap = keys.flag("kidnap", false);
  return pose;
}

/// The data set's table with the frame's keys laid over it.
json laid_over(const json& base, const json& over) {
  json merged = base;
  merged.update(over);
  return merged;
}

DataFrame read_frame(const json& line, const Place& place, const TomlTables& tables, const DataSet& set,
                     KeyNotes& notes) {
  KeyReader keys(line, place, "");
  keys.expect({"image", "t_s", "camera", "mount", "odometry", "imu_yaw_deg", "truth"});
  notes.add(keys);
  DataFrame frame;
  frame.image = keys.text("image", std::nullopt, "name the frame's image, e.g. \"image\": \"images/000.png\"");
  frame.path = set.folder / frame.image;
  frame.has_time = keys.has("t_s");
  frame.time_s = keys.number("t_s", {-1e9, 1e9, "give the frame's time in seconds"}, 0.0);
  const json& camera = keys.table("camera");
  read_camera(laid_over(tables.camera, camera), place, frame.camera, notes, &camera);
  const json& mount = keys.table("mount");
  read_mount_table(laid_over(tables.mount, mount), place, true, frame.camera.mount, notes, &mount);
  frame.has_odometry = keys.has("odometry");
  if (frame.has_odometry) {
    frame.odometry = read_pose(keys.inner("odometry"), "dx_m", "dy_m", "dtheta_deg", any_step_m, notes, nullptr);
  }
  frame.has_yaw = keys.has("imu_yaw_deg");
  const double yaw = keys.number("imu_yaw_deg", {-1e6, 1e6, "give the IMU's yaw in degrees"}, 0.0);
  frame.yaw = as_heading(yaw - set.goal_yaw_deg);
  frame.has_truth = keys.has("truth");
  if (frame.has_truth) {
    frame.truth = read_pose(keys.inner("truth"), "x_m", "y_m", "theta_deg", any_metres, notes, &frame.kidnap);
  }
  return frame;
}

json parse_line(const std::string& text, const std::string& where) {
  try {
    return json::parse(text);
  } catch (const json::exception& error) {
    throw HostError(where + ": not valid JSON: " + error.what() + "; correct or remove that line");
  }
}

/// `newest` is the time of the last line that had one.
void check_order(const DataFrame& frame, std::optional<double>& newest, const std::string& where) {
  if (!frame.has_time) return;
  if (newest && frame.time_s < *newest) {
    throw HostError(where + ": t_s: is smaller than in a line before; put the frames in the order of time");
  }
  newest = frame.time_s;
}

void read_frames(const std::filesystem::path& file, const TomlTables& tables, DataSet& set, KeyNotes& notes) {
  const char* const remedy = "write one JSON object a line, one for each image";
  const std::string lines = read_whole_file(file, {"file", remedy, most_frames_bytes});
  std::optional<double> newest;
  std::size_t begin = 0;
  for (int number = 1; begin < lines.size(); ++number) {
    const std::size_t end = std::min(lines.find('\n', begin), lines.size());
    const std::string text = lines.substr(begin, end - begin);
    begin = end + 1;
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = file.string() + ":" + std::to_string(number);
    set.frames.push_back(read_frame(parse_line(text, where), {file.string(), number}, tables, set, notes));
    set.frames.back().line = number;
    if (set.protocol == Protocol::sequence) check_order(set.frames.back(), newest, where);
  }
  if (set.frames.empty()) throw HostError(file.string() + ": holds no frame; " + remedy);
}

DataSet read_parts(const std::filesystem::path& toml, bool with_frames) {
  DataSet set;
  TomlTables tables;
  KeyNotes notes;
  try {
    read_toml_part(toml, tables, set, notes);
    if (with_frames) read_frames(set.folder / "frames.jsonl", tables, set, notes);
  } catch (const HostError& error) {
    notes.fail(error);
  }
  set.warnings = notes.sentences();
  return set;
}

}  // namespace

const char* to_string(Protocol protocol) { return protocol == Protocol::sequence ? "sequence" : "independent"; }

DataSet read_dataset(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::exists(folder, ignored)) {
    throw HostError(folder.string() +
                    ": no such folder; give a data set's folder, with dataset.toml, frames.jsonl and images");
  }
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw HostError(folder.string() + ": not a folder; give the folder that holds dataset.toml");
  }
  if (std::filesystem::is_empty(folder, ignored)) {
    throw HostError(folder.string() + ": the folder is empty; a data set has dataset.toml, frames.jsonl and images");
  }
  return read_parts(folder / "dataset.toml", true);
}

DataSet read_dataset_toml(const std::filesystem::path& file) { return read_parts(file, false); }

RgbImage read_frame_image(const DataFrame& frame) {
  RgbImage image;
  try {
    image = read_image(frame.path, frame.line > 0 ? "frames.jsonl names it relative to its own folder; correct the path"
                                                  : "give a PNG or JPEG file");
  } catch (const HostError& error) {
    throw FrameError(error.what());
  }
  if (image.width != frame.camera.width || image.height != frame.camera.height) {
    throw FrameError(frame.path.string() + ": the image is " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + ", but camera.width x camera.height of the data set say " +
                     std::to_string(frame.camera.width) + "x" + std::to_string(frame.camera.height) +
                     "; correct the keys or the image");
  }
  return image;
}

}  // namespace touchline::host
