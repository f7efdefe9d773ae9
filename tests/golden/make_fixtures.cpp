// SPDX-License-Identifier: Apache-2.0
// Draws the simulated fixtures once more: data sets small enough for version control, in the format that everybody can
// write. Run by hand where the fixtures themselves are to change; the golden outputs read the files, not the simulator.
//   make_fixtures FIXTURES
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "platform/host/image_file.h"
#include "platform/host/sim/scenario.h"

namespace {

using namespace touchline;
namespace fs = std::filesystem;

double deg(float angle) { return static_cast<double>(degrees(angle)); }

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// A quarter of the pixels of a model's camera, the same field of view.
sim::SimCameraModel half_size(sim::SimCameraModel camera) {
  camera.width /= 2;
  camera.height /= 2;
  camera.lens.focal_px *= 0.5F;
  camera.lens.cx *= 0.5F;
  camera.lens.cy *= 0.5F;
  return camera;
}

class DataSetWriter {
 public:
  DataSetWriter(const fs::path& folder, const char* protocol, const char* field, const sim::SimCameraModel& camera)
      : folder_(folder), camera_(camera) {
    fs::create_directories(folder / "images");
    const char* model = camera.lens.model == LensModel::equisolid ? "equisolid" : "equidistant";
    std::ofstream toml(folder / "dataset.toml");
    toml << format("name = \"%s\"\nprotocol = \"%s\"\nfield = \"%s\"\n\n", folder.filename().c_str(), protocol, field);
    toml << format("[camera]\nwidth = %d\nheight = %d\nmodel = \"%s\"\nfocal_px = %.6f\ncx = %.3f\ncy = %.3f\n",
                   camera.width, camera.height, model, static_cast<double>(camera.lens.focal_px),
                   static_cast<double>(camera.lens.cx), static_cast<double>(camera.lens.cy));
    toml << format("max_theta_deg = %.4f\n\n", deg(camera.lens.max_theta));
    toml << "[mount]\nheight_m = 0.58\npitch_deg = 30.0\n\n[imu]\ngoal_yaw_deg = 0.0\n";
    frames_.open(folder / "frames.jsonl");
  }

  void add(const sim::SimFrame& frame) {
    const std::string name = format("images/%03d.png", count_++);
    host::RgbImage image(camera_.width, camera_.height);
    image.rgb.assign(frame.image.data, frame.image.data + image.rgb.size());
    host::write_png(folder_ / name, image);
    frames_ << format("{\"image\": \"%s\", \"t_s\": %.4f, ", name.c_str(), frame.time_s);
    frames_ << format("\"mount\": {\"height_m\": %.4f, \"pitch_deg\": %.3f, \"roll_deg\": %.3f}, ",
                      static_cast<double>(frame.mount.height), deg(frame.mount.pitch), deg(frame.mount.roll));
    frames_ << format("\"odometry\": {\"dx_m\": %.5f, \"dy_m\": %.5f, \"dtheta_deg\": %.4f}, ",
                      static_cast<double>(frame.odometry.x), static_cast<double>(frame.odometry.y),
                      deg(frame.odometry.theta));
    if (frame.has_yaw) frames_ << format("\"imu_yaw_deg\": %.3f, ", deg(wrap_angle(frame.yaw)));
    frames_ << format("\"truth\": {\"x_m\": %.4f, \"y_m\": %.4f, \"theta_deg\": %.3f}}\n",
                      static_cast<double>(frame.truth.x), static_cast<double>(frame.truth.y), deg(frame.truth.theta));
  }

 private:
  fs::path folder_;
  sim::SimCameraModel camera_;
  std::ofstream frames_;
  int count_ = 0;
};

/// A walk of the paper's robot on the paper's field: FIFO, odometry, feature manager over frames.
void make_walk(const fs::path& folder) {
  const sim::SimCameraModel camera = half_size(*sim::camera_model("fisheye-185"));
  sim::WalkScenarioOptions options = sim::acceptance_walk(*field_preset("acyut-5x3"), camera, 7);
  options.effects.noise = 1.0F;  // a PNG of noise is large
  sim::WalkScenario walk(options);
  DataSetWriter writer(folder, "sequence", "acyut-5x3", camera);
  for (int i = 0; i < 8; ++i) writer.add(walk.next());
}

/// Single pictures of today's field through a narrower lens, each from nothing.
void make_poses(const fs::path& folder) {
  sim::PoseScenarioOptions options;
  options.field = *field_preset("small-2026");
  options.camera = half_size(*sim::camera_model("fisheye-140"));
  options.seed = 3;
  options.yaw = true;
  options.frames_per_scene = 1;
  sim::PoseScenario poses(options);
  DataSetWriter writer(folder, "independent", "small-2026", options.camera);
  for (int i = 0; i < 4; ++i) writer.add(poses.frame(i));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: make_fixtures FIXTURES\n", stderr);
    return 2;
  }
  try {
    make_walk(fs::path(argv[1]) / "sim-walk");
    make_poses(fs::path(argv[1]) / "sim-poses");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_fixtures: %s\n", error.what());
    return 2;
  }
}
