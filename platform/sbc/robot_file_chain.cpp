// SPDX-License-Identifier: Apache-2.0
// The tables of field, vision and localization.
#include <cmath>

#include <nlohmann/json.hpp>

#include "platform/host/chain_tables.h"
#include "platform/processor/fastest_kernels.h"
#include "platform/sbc/robot_file_tables.h"

namespace touchline::sbc {
namespace {

/// Six numbers; `wraps`: the hue's low may be above its high.
HsvRange read_range(KeyReader& table, const char* key, bool wraps, const HsvRange& fallback) {
  const std::vector<double> v = table.numbers(key, 6, 6);
  if (v.empty()) return fallback;
  for (const double value : v) {
    if (value < 0.0 || value > 255.0 || value != std::floor(value)) {
      table.fail(key, "holds a number outside 0 to 255, or no whole one; hue counts 0 to 179");
    }
  }
  if (v[0] > 179.0 || v[1] > 179.0) table.fail(key, "has a hue above 179; hue counts 0 to 179, 2 degrees a step");
  // Hue is a circle: a range of it may go over 0, where the chain can do with that.
  if ((!wraps && v[0] > v[1]) || v[2] > v[3] || v[4] > v[5])
    table.fail(key, "has a low bound above the high one; write h, h, s, s, v, v");
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(v[i]); };
  return {byte(0), byte(1), byte(2), byte(3), byte(4), byte(5)};
}

void read_body_mask(KeyReader& table, VisionConfig& vision) {
  const auto polygons = table.lists("body_mask_px", static_cast<double>(max_mask_coordinate_px));
  if (polygons.size() > max_mask_polygons) {
    table.fail("body_mask_px", "has more than " + std::to_string(max_mask_polygons) + " polygons");
  }
  for (const auto& numbers : polygons) {
    if (numbers.size() % 2 != 0 || numbers.size() < 6 || numbers.size() / 2 > max_mask_polygon_points) {
      table.fail("body_mask_px", "has a polygon of " + std::to_string(numbers.size()) + " numbers; write 3 to " +
                                     std::to_string(max_mask_polygon_points) + " points as u, v, u, v, ...");
    }
    MaskPolygon polygon;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
      polygon.push_back({static_cast<float>(numbers[i]), static_cast<float>(numbers[i + 1])});
    }
    vision.body_mask.push_back(polygon);
  }
}

int odd(KeyReader& table, const char* key, int fallback) {
  const int value = table.integer(key, 1, 31, fallback);
  if (value % 2 == 0) table.fail(key, "is even; the side of a kernel is odd");
  return value;
}

void read_prior(KeyReader table, Prior& prior) {
  const std::vector<std::string> kinds{"uniform", "own_half", "touch_line", "pose"};
  prior.kind = static_cast<PriorKind>(table.choice("kind", kinds, static_cast<std::size_t>(prior.kind)));
  prior.pose.x = table.real("x_m", -10.0, 10.0, prior.pose.x);
  prior.pose.y = table.real("y_m", -10.0, 10.0, prior.pose.y);
  prior.pose.theta = table.angle("theta_deg", -360.0, 360.0, prior.pose.theta);
  prior.sigma_xy = table.real("sigma_m", 0.01, 10.0, prior.sigma_xy);
  prior.sigma_theta = table.angle("sigma_deg", 0.1, 180.0, prior.sigma_theta);
  table.finish();
}

}  // namespace

void read_field(KeyReader& top, RobotFile& file) {
  std::optional<host::NamedField> fallback{{"small-2026", *field_preset("small-2026")}};
  if (file.camera_backend == CameraBackend::replay) fallback = {"the data set's", file.robot.field};
  const bool named = top.has("field") && (!top.find("field")->is_object() || !top.find("field")->empty());
  file.robot.field = host::read_field(top, fallback, nullptr).dimensions;
  tell_vision(file.robot.field, file.robot.vision);
  if (!named && file.camera_backend != CameraBackend::replay) {
    file.notes.emplace_back("[field] is the default, preset = \"small-2026\"; name yours");
  }
}

void read_vision(KeyReader table, RobotFile& file) {
  VisionConfig& vision = file.robot.vision;
  vision.kernels = fastest_kernels();
  vision.fifo_depth = table.integer("fifo_depth", 1, 4, vision.fifo_depth);  // the daemon's storage holds four
  vision.green = read_range(table, "green_hsv", false, vision.green);
  vision.yellow_post = read_range(table, "yellow_post_hsv", true, vision.yellow_post);
  vision.white_posts = table.flag("white_posts", vision.white_posts);
  vision.green_erode_px = odd(table, "green_erode_px", vision.green_erode_px);
  vision.green_dilate_px = odd(table, "green_dilate_px", vision.green_dilate_px);
  vision.line_dilate_px = odd(table, "line_dilate_px", vision.line_dilate_px);
  vision.line_erode_px = odd(table, "line_erode_px", vision.line_erode_px);
  vision.digestion_radius_px = table.integer("digestion_radius_px", 1, 15, vision.digestion_radius_px);
  vision.spur_px = table.integer("spur_px", 0, 60, vision.spur_px);
  vision.max_range_m = table.real("max_range_m", 0.5, 20.0, vision.max_range_m);
  read_body_mask(table, vision);
  table.finish();
}

void read_localization(KeyReader table, RobotFile& file) {
  LocalizerConfig& config = file.robot.localizer;
  config.kernels = fastest_loc_kernels();
  config.model = table.choice("model", {"full", "paper"}, 0) == 1 ? LocModel::paper : LocModel::full;
  constexpr Landmarks kinds[] = {Landmarks::lines, Landmarks::goalposts, Landmarks::both};
  config.landmarks = kinds[table.choice("landmarks", {"lines", "goalposts", "both"}, 0)];
  config.particles = table.integer("particles", 10, max_particles, config.particles);
  MotionNoise& motion = config.motion;
  motion.xy_per_metre = table.real("noise_m_per_m", 0.0, 2.0, motion.xy_per_metre);
  motion.theta_per_metre = table.angle("noise_deg_per_m", 0.0, 180.0, motion.theta_per_metre);
  motion.theta_per_radian = table.real("noise_rad_per_rad", 0.0, 2.0, motion.theta_per_radian);
  config.yaw_sigma = table.angle("yaw_sigma_deg", 0.01, 90.0, config.yaw_sigma);
  config.yaw_drift_rate = table.angle("yaw_drift_deg_per_sqrt_s", 0.0, 10.0, config.yaw_drift_rate);
  config.tilt_sigma = table.angle("tilt_sigma_deg", 0.0, 10.0, config.tilt_sigma);
  config.confident = table.real("confident", 0.05, 1.0, config.confident);
  file.robot.seed = static_cast<std::uint64_t>(table.integer("seed", 0, 1000000000, 1));
  read_prior(table.inner("prior"), file.robot.prior);
  table.finish();
}

}  // namespace touchline::sbc
