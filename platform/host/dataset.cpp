// SPDX-License-Identifier: Apache-2.0
// dataset.toml and frames.jsonl, key by key.
#include "platform/host/dataset.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "platform/host/key_notes.h"
#include "platform/host/key_reader.h"
#include "platform/host/toml_file.h"

namespace touchline::host {
namespace {

using nlohmann::json;
constexpr double any_metres = 1000.0;  // a field is 14 m; more is a slip of units

struct ModelName {
  const char* name;
  LensModel model;
};
constexpr ModelName model_names[] = {
    {"equidistant", LensModel::equidistant}, {"equisolid", LensModel::equisolid},
    {"rectilinear", LensModel::rectilinear}, {"kannala_brandt", LensModel::kannala_brandt},
    {"barrel", LensModel::barrel},           {"polynomial", LensModel::polynomial},
};
constexpr const char* field_names[] = {"acyut-5x3", "kidsize-9x6", "small-2026", "middle-2026"};

float as_float(double value) { return static_cast<float>(value); }
float as_radians(double value) { return static_cast<float>(value * 3.14159265358979323846 / 180.0); }
float as_heading(double value) { return wrap_angle(as_radians(value)); }

std::string unknown_name(const std::string& name, const std::vector<std::string>& known) {
  std::string text = "\"" + name + "\" is not known; known are";
  for (const auto& k : known) text += (&k == &known.front() ? " " : ", ") + k;
  const std::string near = nearest_word(name, known);
  return near.empty() ? text : text + "; did you mean " + near + "?";
}

LensModel read_model(KeyReader& keys) {
  const std::string name = keys.text("model", std::nullopt, "give the lens model, e.g. model = \"equidistant\"");
  std::vector<std::string> known;
  for (const auto& entry : model_names) {
    if (name == entry.name) return entry.model;
    known.emplace_back(entry.name);
  }
  keys.fail("model", unknown_name(name, known));
}

template <std::size_t N>
void read_coefficients(KeyReader& keys, const char* key, std::array<float, N>& out) {
  const auto values = keys.numbers(key, N);
  out.fill(0.0F);
  for (std::size_t i = 0; i < values.size(); ++i) out[i] = as_float(values[i]);
}

void read_camera(const json& table, const std::string& where, CameraSetup& out, KeyNotes& notes,
                 const json* own = nullptr) {
  KeyReader keys(table, where, "camera.");
  keys.expect(
      {"width", "height", "model", "focal_px", "cx", "cy", "max_theta_deg", "alpha", "a", "b", "k1", "k2", "k3", "k4"});
  notes.add(keys, own);
  out.width = keys.integer("width", 16, max_frame_width, "give the images' width in pixels, at most 1280");
  out.height = keys.integer("height", 16, max_frame_height, "give the images' height in pixels, at most 1024");
  LensParameters& lens = out.lens;
  lens = {};
  lens.model = read_model(keys);
  lens.focal_px = as_float(keys.number("focal_px", {1.0, 1e5, "give the focal length in camera pixels"}));
  lens.cx = as_float(keys.number("cx", {-1e4, 1e4, "give the principal point in camera pixels"}, out.width * 0.5));
  lens.cy = as_float(keys.number("cy", {-1e4, 1e4, "give the principal point in camera pixels"}, out.height * 0.5));
  lens.max_theta = as_radians(keys.number(
      "max_theta_deg", {1.0, 180.0, "give the angle from the optical axis that the lens sees, in degrees"}));
  if (lens.model == LensModel::barrel) {
    lens.alpha = as_float(keys.number("alpha", {-1.0, 1.0, "give alpha of the barrel model in 1/px^2"}));
  }
  if (lens.model == LensModel::polynomial) {
    read_coefficients(keys, "a", lens.a);
    if (keys.has("b")) read_coefficients(keys, "b", lens.b);
  }
  static constexpr const char* k_names[] = {"k1", "k2", "k3", "k4"};
  for (std::size_t i = 0; i < 4; ++i) {  // asked for in any case: a frame may switch to a model without them
    const bool needed = lens.model == LensModel::kannala_brandt;
    const double k = keys.number(k_names[i], {-1e3, 1e3, "give the model's coefficient"},
                                 needed ? std::nullopt : std::optional(0.0));
    if (needed) lens.k[i] = as_float(k);
  }
  const char* what = nullptr;
  Lens checked;
  if (Lens::create(lens, checked, &what) != Status::ok) {
    keys.fail("model", std::string("these lens parameters do not fit together: ") +
                           (what != nullptr ? what : "refused") + "; check them against the lens's calibration");
  }
}

/// `need_height` false: it may come later, and is 0 until then.
void read_mount(const json& table, const std::string& where, bool need_height, CameraPose& out, KeyNotes& notes,
                const json* own = nullptr) {
  KeyReader keys(table, where, "mount.");
  keys.expect({"x_m", "y_m", "height_m", "yaw_deg", "pitch_deg", "roll_deg"});
  notes.add(keys, own);
  const NumberRange offset{-10.0, 10.0, "give the camera's place in the robot in metres"};
  const NumberRange angle{-360.0, 360.0, "give the camera's angle in degrees"};
  out.x = as_float(keys.number("x_m", offset, 0.0));
  out.y = as_float(keys.number("y_m", offset, 0.0));
  const NumberRange height{0.01, 10.0, "give the camera's height above the carpet in metres, > 0"};
  out.height = as_float(keys.number("height_m", height, need_height ? std::nullopt : std::optional(0.0)));
  out.yaw = as_radians(keys.number("yaw_deg", angle, 0.0));
  out.pitch = as_radians(keys.number("pitch_deg", angle, 0.0));
  out.roll = as_radians(keys.number("roll_deg", angle, 0.0));
}

struct FieldKey {
  const char* name;
  float FieldDimensions::*member;
  bool required;
};
constexpr FieldKey field_keys[] = {
    {"length", &FieldDimensions::length, true},
    {"width", &FieldDimensions::width, true},
    {"line_width", &FieldDimensions::line_width, true},
    {"circle_radius", &FieldDimensions::circle_radius, true},
    {"goal_area_depth", &FieldDimensions::goal_area_depth, false},
    {"goal_area_width", &FieldDimensions::goal_area_width, false},
    {"penalty_area_depth", &FieldDimensions::penalty_area_depth, false},
    {"penalty_area_width", &FieldDimensions::penalty_area_width, false},
    {"penalty_mark", &FieldDimensions::penalty_mark, false},
    {"goal_width", &FieldDimensions::goal_width, true},
    {"goal_height", &FieldDimensions::goal_height, true},
    {"post_diameter", &FieldDimensions::post_diameter, true},
    {"border", &FieldDimensions::border, true},
};

void check_field(const FieldDimensions& dimensions, KeyReader& keys) {
  const char* what = nullptr;
  Field checked;
  if (Field::create(dimensions, checked, &what) != Status::ok) {
    keys.fail(what != nullptr ? what : "field", "does not fit the rest of the field; check it against the rule book");
  }
}

void read_field(KeyReader& top, DataSet& out, KeyNotes& notes) {
  const json* value = top.find("field");
  if (value == nullptr)
    top.fail("field", "is missing; name a preset, e.g. field = \"small-2026\", or give a [field] table");
  if (value->is_string()) {
    const auto preset = field_preset(value->get<std::string>());
    if (!preset)
      top.fail("field", unknown_name(value->get<std::string>(), {std::begin(field_names), std::end(field_names)}));
    out.field_name = value->get<std::string>();
    out.field = *preset;
    return;
  }
  if (!value->is_object())
    top.fail("field", "is " + value->dump() + "; name a preset in quotes or give a [field] table");
  KeyReader keys(*value, top.where(), "field.");
  for (const auto& key : field_keys) keys.expect({key.name});
  notes.add(keys);
  out.field_name = "free";
  const NumberRange metres{0.0, any_metres, "give the length in metres, between the centres of lines"};
  for (const auto& key : field_keys) {
    out.field.*key.member = as_float(keys.number(key.name, metres, key.required ? std::nullopt : std::optional(0.0)));
  }
  check_field(out.field, keys);
}

Protocol read_protocol(KeyReader& keys) {
  const std::string name = keys.text("protocol", "independent");
  if (name == "independent") return Protocol::independent;
  if (name == "sequence") return Protocol::sequence;
  keys.fail("protocol", unknown_name(name, {"independent", "sequence"}));
}

/// What the frames need of dataset.toml beside the parsed values: the raw tables that a frame's keys are laid over.
struct TomlTables {
  json camera = json::object();
  json mount = json::object();
};

void read_toml_part(const std::filesystem::path& file, TomlTables& tables, DataSet& out, KeyNotes& notes) {
  const json root = read_toml(file);
  const std::string where = file.string();
  KeyReader keys(root, where, "");
  keys.expect({"name", "protocol", "field", "camera", "mount", "imu"});
  notes.add(keys);
  out.folder = file.parent_path();
  out.name = keys.text("name", std::filesystem::absolute(out.folder / ".").parent_path().filename().string());
  out.protocol = read_protocol(keys);
  read_field(keys, out, notes);
  tables.camera = keys.required_table("camera", "write [camera], with the lens and the size of the images");
  tables.mount = keys.table("mount");
  read_camera(tables.camera, where, out.camera, notes);
  read_mount(tables.mount, where, false, out.camera.mount, notes);
  KeyReader imu(keys.table("imu"), where, "imu.");
  imu.expect({"goal_yaw_deg"});
  notes.add(imu);
  out.goal_yaw_deg = imu.number("goal_yaw_deg", {-1e6, 1e6, "give the IMU's reading in degrees"}, 0.0);
}

Pose2 read_pose(const json& table, const std::string& where, const char* prefix, const char* x, const char* y,
                const char* theta, KeyNotes& notes, bool* kidnap) {
  KeyReader keys(table, where, prefix);
  keys.expect({x, y, theta});
  if (kidnap != nullptr) keys.expect({"kidnap"});
  notes.add(keys);
  const NumberRange metres{-any_metres, any_metres, "give it in metres"};
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

DataFrame read_frame(const json& line, const std::string& where, const TomlTables& tables, const DataSet& set,
                     KeyNotes& notes) {
  KeyReader keys(line, where, "");
  keys.expect({"image", "t_s", "camera", "mount", "odometry", "imu_yaw_deg", "truth"});
  notes.add(keys);
  DataFrame frame;
  frame.image = keys.text("image", std::nullopt, "name the frame's image, e.g. \"image\": \"images/000.png\"");
  frame.path = set.folder / frame.image;
  frame.has_time = keys.has("t_s");
  frame.time_s = keys.number("t_s", {-1e9, 1e9, "give the frame's time in seconds"}, 0.0);
  const json& camera = keys.table("camera");
  read_camera(laid_over(tables.camera, camera), where, frame.camera, notes, &camera);
  const json& mount = keys.table("mount");
  read_mount(laid_over(tables.mount, mount), where, true, frame.camera.mount, notes, &mount);
  frame.has_odometry = keys.has("odometry");
  if (frame.has_odometry) {
    frame.odometry =
        read_pose(keys.table("odometry"), where, "odometry.", "dx_m", "dy_m", "dtheta_deg", notes, nullptr);
  }
  frame.has_yaw = keys.has("imu_yaw_deg");
  const double yaw = keys.number("imu_yaw_deg", {-1e6, 1e6, "give the IMU's yaw in degrees"}, 0.0);
  frame.yaw = as_heading(yaw - set.goal_yaw_deg);
  frame.has_truth = keys.has("truth");
  if (frame.has_truth) {
    frame.truth = read_pose(keys.table("truth"), where, "truth.", "x_m", "y_m", "theta_deg", notes, &frame.kidnap);
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

void check_order(const std::vector<DataFrame>& frames, const std::string& where) {
  if (frames.size() < 2) return;
  const auto& last = frames.back();
  const auto& before = frames[frames.size() - 2];
  if (last.has_time && before.has_time && last.time_s < before.time_s) {
    throw HostError(where + ": t_s: is smaller than the line before; put the frames in the order of time");
  }
}

void read_frames(const std::filesystem::path& file, const TomlTables& tables, DataSet& set, KeyNotes& notes) {
  std::ifstream in(file);
  if (!in) throw HostError(file.string() + ": no such file; write one JSON object a line, one for each image");
  std::string text;
  for (int number = 1; std::getline(in, text); ++number) {
    if (text.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = file.string() + ": line " + std::to_string(number);
    set.frames.push_back(read_frame(parse_line(text, where), where, tables, set, notes));
    set.frames.back().line = number;
    if (set.protocol == Protocol::sequence) check_order(set.frames, where);
  }
  if (set.frames.empty())
    throw HostError(file.string() + ": holds no frame; write one JSON object a line, one for each image");
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
    image = read_image(frame.path);
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
