// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/data_set_writer.h"

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>

#include "platform/host/host_error.h"
#include "platform/host/image_file.h"

namespace touchline::sim {
namespace {

using Json = nlohmann::ordered_json;

/// As many decimals as a reader can use: 0.01 mm, 0.0001 degrees.
double rounded(float value, double scale) { return std::round(static_cast<double>(value) * scale) / scale; }
double metres(float value) { return rounded(value, 1e5); }
double in_degrees(float angle) { return rounded(degrees(angle), 1e4); }

const char* model_name(LensModel model) {
  switch (model) {
    case LensModel::equidistant: return "equidistant";
    case LensModel::equisolid: return "equisolid";
    case LensModel::rectilinear: return "rectilinear";
    case LensModel::kannala_brandt: return "kannala_brandt";
    case LensModel::barrel: return "barrel";
    case LensModel::polynomial: return "polynomial";
  }
  return "";
}

void write_lens(std::ostream& out, const LensParameters& lens) {
  out << "model = \"" << model_name(lens.model) << "\"\nfocal_px = " << lens.focal_px << "\ncx = " << lens.cx
      << "\ncy = " << lens.cy << "\nmax_theta_deg = " << degrees(lens.max_theta) << "\n";
  if (lens.model == LensModel::kannala_brandt) {
    for (std::size_t i = 0; i < lens.k.size(); ++i) out << "k" << i + 1 << " = " << lens.k[i] << "\n";
  }
  if (lens.model == LensModel::barrel) out << "alpha = " << lens.alpha << "\n";
  if (lens.model == LensModel::polynomial) {
    const auto list = [&](const char* key, const std::array<float, 8>& values) {
      out << key << " = [";
      for (std::size_t i = 0; i < values.size(); ++i) out << (i > 0 ? ", " : "") << values[i];
      out << "]\n";
    };
    list("a", lens.a);
    list("b", lens.b);
  }
}

void write_field(std::ostream& out, const FieldDimensions& f) {
  out << "\n[field]\nlength = " << f.length << "\nwidth = " << f.width << "\nline_width = " << f.line_width
      << "\ncircle_radius = " << f.circle_radius << "\ngoal_area_depth = " << f.goal_area_depth
      << "\ngoal_area_width = " << f.goal_area_width << "\npenalty_area_depth = " << f.penalty_area_depth
      << "\npenalty_area_width = " << f.penalty_area_width << "\npenalty_mark = " << f.penalty_mark
      << "\ngoal_width = " << f.goal_width << "\ngoal_height = " << f.goal_height
      << "\npost_diameter = " << f.post_diameter << "\nborder = " << f.border << "\n";
}

Json pair(double a, double b) { return Json::array({a, b}); }
Json pixel(const PixelPoint& p) { return pair(rounded(p.u, 1e3), rounded(p.v, 1e3)); }

/// Opens for writing or throws with the file's name.
std::ofstream open_file(const std::filesystem::path& path) {
  std::ofstream out(path);
  if (!out) throw host::HostError(path.string() + ": cannot be written; check the folder's rights and free space");
  out << std::fixed << std::setprecision(5);
  return out;
}

void finish_file(std::ofstream& out, const std::filesystem::path& path) {
  if (!out.flush()) throw host::HostError(path.string() + ": cannot be written to its end; is the disk full?");
}

}  // namespace

DataSetWriter::DataSetWriter(const std::filesystem::path& folder, const DataSetHead& head)
    : folder_(folder), head_(head) {
  const char* what = nullptr;
  if (Field::create(head.field, field_, &what) != Status::ok) {
    throw host::HostError(std::string("field: ") + (what != nullptr ? what : "dimension") +
                          " is out of range; see --help");
  }
  std::error_code error;
  if (std::filesystem::exists(folder, error) && !std::filesystem::is_empty(folder, error)) {
    throw host::HostError(folder.string() + ": exists and is not empty; choose another folder or empty it");
  }
  std::filesystem::create_directories(folder / "images", error);
  if (!error) std::filesystem::create_directories(folder / "expected", error);
  if (error) throw host::HostError(folder.string() + ": cannot be created (" + error.message() + ")");
  write_head();
  lines_ = open_file(folder / "frames.jsonl");
}

void DataSetWriter::write_head() const {
  std::ofstream out = open_file(folder_ / "dataset.toml");
  out << "name = \"" << head_.name << "\"\nprotocol = \"" << host::to_string(head_.protocol) << "\"\n";
  if (!head_.field_name.empty()) out << "field = \"" << head_.field_name << "\"\n";
  out << "\n[camera]\nwidth = " << head_.camera.width << "\nheight = " << head_.camera.height << "\n";
  write_lens(out, head_.camera.lens);
  out << "\n[mount]\nx_m = " << head_.mount.x << "\ny_m = " << head_.mount.y << "\nheight_m = " << head_.mount.height
      << "\nyaw_deg = " << degrees(head_.mount.yaw) << "\npitch_deg = " << degrees(head_.mount.pitch)
      << "\nroll_deg = " << degrees(head_.mount.roll) << "\n\n[imu]\ngoal_yaw_deg = " << degrees(head_.goal_yaw)
      << "\n";
  if (head_.field_name.empty()) write_field(out, head_.field);
  finish_file(out, folder_ / "dataset.toml");
}

void DataSetWriter::write_image(const SimFrame& frame, const std::string& name) const {
  host::RgbImage image(frame.image.width, frame.image.height);
  image.rgb.assign(frame.image.data, frame.image.data + image.rgb.size());
  if (head_.jpeg_quality > 0) {
    host::write_jpeg(folder_ / name, image, head_.jpeg_quality);
  } else {
    host::write_png(folder_ / name, image);
  }
}

void DataSetWriter::write_expected(const SimFrame& frame, const Scene& scene, const Lens& lens,
                                   const std::string& number, const std::string& image) const {
  Json list = Json::array();
  for (const ExpectedLandmark& mark : expected_landmarks(field_, scene, lens, frame)) {
    Json entry{{"type", mark.type},
               {"name", mark.name},
               {"world", Json::array({metres(mark.world.x), metres(mark.world.y), 0.0})},
               {"px", pixel(mark.px)},
               {"theta_deg", in_degrees(mark.theta)},
               {"range_m", metres(mark.range)},
               {"bearing_deg", in_degrees(mark.bearing)},
               {"occluded", mark.occluded}};
    if (mark.type == "G") entry["front_foot_px"] = pixel(mark.front_foot_px);
    list.push_back(entry);
  }
  const auto path = folder_ / "expected" / (number + ".json");
  std::ofstream out = open_file(path);
  out << Json{{"image", image}, {"landmarks", list}}.dump(1) << "\n";
  finish_file(out, path);
}

void DataSetWriter::add(const SimFrame& frame, const Scene& scene, const Lens& lens) {
  std::ostringstream digits;
  digits << std::setw(3) << std::setfill('0') << count_;
  const std::string number = digits.str();
  const std::string file = number + (head_.jpeg_quality > 0 ? ".jpg" : ".png");
  write_image(frame, "images/" + file);
  write_expected(frame, scene, lens, number, file);
  Json line{{"image", "images/" + file}};
  if (head_.protocol == host::Protocol::sequence) line["t_s"] = std::round(frame.time_s * 1e6) / 1e6;
  line["mount"] = {{"x_m", metres(frame.mount.x)},
                   {"y_m", metres(frame.mount.y)},
                   {"height_m", metres(frame.mount.height)},
                   {"yaw_deg", in_degrees(frame.mount.yaw)},
                   {"pitch_deg", in_degrees(frame.mount.pitch)},
                   {"roll_deg", in_degrees(frame.mount.roll)}};
  if (head_.protocol == host::Protocol::sequence) {
    line["odometry"] = {{"dx_m", metres(frame.odometry.x)},
                        {"dy_m", metres(frame.odometry.y)},
                        {"dtheta_deg", in_degrees(frame.odometry.theta)}};
  }
  if (frame.has_yaw) line["imu_yaw_deg"] = in_degrees(wrap_angle(frame.yaw + head_.goal_yaw));
  line["truth"] = {
      {"x_m", metres(frame.truth.x)}, {"y_m", metres(frame.truth.y)}, {"theta_deg", in_degrees(frame.truth.theta)}};
  if (frame.kidnapped) line["truth"]["kidnap"] = true;
  lines_ << line.dump() << "\n";
  finish_file(lines_, folder_ / "frames.jsonl");
  count_ += 1;
}

}  // namespace touchline::sim
