// SPDX-License-Identifier: Apache-2.0
// Draws a simulated walk beforehand, for the virtual machine to play: make_walk FOLDER SECONDS.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "platform/host/sim/scenario.h"

int main(int argc, char** argv) {
  using namespace touchline;
  if (argc != 3) return std::fprintf(stderr, "make_walk FOLDER SECONDS\n"), 2;
  const std::string folder = argv[1];
  const double seconds = std::atof(argv[2]);
  sim::WalkScenarioOptions options =
      sim::acceptance_walk(*field_preset("acyut-5x3"), *sim::camera_model("fisheye-140"), 42);
  options.frames_per_second = 10.0F;
  options.readings_per_frame = 10;
  sim::WalkScenario walk(options);
  if (!walk.ready()) return 1;
  std::ofstream pictures(folder + "/walk.yuyv", std::ios::binary);
  std::FILE* text = std::fopen((folder + "/walk.txt").c_str(), "w");
  if (text == nullptr) return 1;
  std::vector<std::uint8_t> rgb, yuyv;
  while (true) {
    const sim::SimFrame& frame = walk.next();
    if (frame.time_s > seconds) break;
    for (const sim::SimReading& r : walk.readings()) {
      const auto d = [](float v) { return static_cast<double>(v); };
      std::fprintf(text, "%.6f %.6f %.6f %.6f %.6f %.6f %.6f %.6f\n", r.time_s, d(r.odometry.x), d(r.odometry.y),
                   d(r.odometry.theta), d(r.yaw - options.imu.goal_yaw), d(r.mount.height), d(r.mount.pitch),
                   d(r.mount.roll));
    }
    std::fprintf(text, "frame %.6f %.6f %.6f %.6f\n", frame.time_s, static_cast<double>(frame.truth.x),
                 static_cast<double>(frame.truth.y), static_cast<double>(frame.truth.theta));
    rgb.assign(frame.image.data,
               frame.image.data + static_cast<std::ptrdiff_t>(frame.image.stride_bytes) * frame.image.height);
    sim::convert_rgb24(rgb, frame.image.width, frame.image.height, PixelFormat::yuyv, yuyv);
    pictures.write(reinterpret_cast<const char*>(yuyv.data()), static_cast<std::streamsize>(yuyv.size()));
  }
  std::fclose(text);
  const LensParameters& lens = options.camera.lens;
  std::ofstream toml(folder + "/robot.toml");
  toml << "[camera]\ndevice = \""
       << "vivid\"\ninput = 1\nwidth_px = " << options.camera.width << "\nheight_px = " << options.camera.height
       << "\nrate_hz = 0\ndelay_ms = 60\n[field]\npreset = \"acyut-5x3\"\n[lens]\nmodel = \"equisolid\"\nfocal_px = "
       << lens.focal_px << "\ncx = " << lens.cx << "\ncy = " << lens.cy
       << "\nmax_theta_deg = " << degrees(lens.max_theta)
       << "\n[mount]\nheight_m = 0.58\npitch_deg = 30\n[imu]\nbackend = \"hidapi\"\ndevice = \"1209:0001\"\n"
       << "[gait]\nbackend = \"serial\"\ndevice = \"/dev/gait-robot\"\n"
       << "[realtime]\nlock_memory = true\n"  // the panel's table last: the tests add to it
       << "[panel]\nbackend = \"gpiod\"\nchip = \"cp2112_gpio\"\nbutton_line = 2\nled_line = 5\n";
  return 0;
}
