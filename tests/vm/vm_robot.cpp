// SPDX-License-Identifier: Apache-2.0
// Runs inside the virtual machine: plays a whole robot on the kernel's devices to the unchanged daemon, and judges its
// poses. Pictures go into vivid's looped output, the yaw into a uhid IMU, the steps into a serial port; the button is
// that of an emulated CP2112.  vm_robot WALK_FOLDER DAEMON_OUTPUT READY_FILE First the robot stands and looks at the
// goal: a short press stores the yaw. Then it is lifted, turned and put down where the walk begins. The daemon writes
// JSON lines into DAEMON_OUTPUT, with times of the clock that this program has too.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hal/linux/monotonic_clock.h"
#include "tests/hal/gait_header.h"
#include "tests/vm/raw_serial.h"
#include "tests/vm/uhid_device.h"
#include "tests/vm/vivid.h"
#include "tests/vm/walk_file.h"

namespace touchline::vm {
namespace {

constexpr std::size_t picture_bytes = 640 * 480 * 2;
constexpr double before_walk_s = 14.0;  // standing, button, turning
constexpr double settle_s = 3.0;        // of the walk, that do not count

MonotonicClock clock_now;

struct Stage {
  VividOutput output;
  UhidImu imu;
  UhidGpio panel;
  int serial = -1;
  std::uint32_t sequence = 0;
  MonotonicNs start = 0;

  bool set_up() {
    if (!output.open()) return std::printf("FAIL vivid's output cannot be used\n"), false;
    if (!imu.plug_in() || !panel.plug_in()) return std::printf("FAIL uhid cannot be used\n"), false;
    serial = open_raw("/dev/gait-controller");
    return serial >= 0;
  }
  void send_gait(const WalkReading& r, std::uint8_t flags) {
    touchline_gait gait{};
    gait.flags = static_cast<std::uint8_t>(flags | TOUCHLINE_GAIT_HAS_CAMERA);
    gait.boot_id = 1;
    gait.sequence = sequence++;
    gait.time_us = static_cast<std::uint32_t>((clock_now.now() - start) / 1000);
    gait.x_m = r.odometry.x;
    gait.y_m = r.odometry.y;
    gait.theta_rad = r.odometry.theta;
    gait.camera_height_m = r.height;
    gait.camera_pitch_rad = r.pitch;
    gait.camera_roll_rad = r.roll;
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    (void)!::write(serial, frame, sizeof frame);
  }
};

/// Looks at the goal, presses the button, is carried to the start.
void before_the_walk(Stage& stage, const Walk& walk, const std::uint8_t* first_picture) {
  const WalkReading& first = walk.readings.front();
  const MonotonicNs begin = clock_now.now();
  for (int i = 0; i < static_cast<int>(before_walk_s * 50.0); ++i) {
    const double t = i * 0.02;
    stage.panel.set_line(2, !(t > 9.0 && t < 9.8));  // long enough for an emulated processor to see
    const double turned = std::clamp((t - 11.0) / 2.0, 0.0, 1.0);
    stage.imu.send(first.yaw * static_cast<float>(turned));
    stage.send_gait(first, t > 10.5 && t < 13.5 ? TOUCHLINE_GAIT_LIFTED : TOUCHLINE_GAIT_STANDING);
    if (i % 5 == 0) stage.output.show(first_picture, 200);
    clock_now.wait_until(begin + from_seconds(t + 0.02));
  }
}

/// Plays readings and pictures at their times; a picture that is late is left out, as a camera would.
int play(Stage& stage, const Walk& walk, std::ifstream& pictures, MonotonicNs begin) {
  std::vector<std::uint8_t> picture(picture_bytes);
  std::size_t next_picture = 0;
  int shown = 0;
  for (const WalkReading& reading : walk.readings) {
    const MonotonicNs due = begin + from_seconds(reading.time_s);
    clock_now.wait_until(due);
    stage.imu.send(reading.yaw);
    stage.send_gait(reading, TOUCHLINE_GAIT_WALKING);
    while (next_picture + 1 < walk.frames.size() &&
           walk.frames[next_picture + 1].time_s <= to_seconds(clock_now.now() - begin))
      ++next_picture;
    if (next_picture >= walk.frames.size() || walk.frames[next_picture].time_s > to_seconds(clock_now.now() - begin))
      continue;
    pictures.seekg(static_cast<std::streamoff>(next_picture * picture_bytes));
    pictures.read(reinterpret_cast<char*>(picture.data()), static_cast<std::streamsize>(picture_bytes));
    shown += stage.output.show(picture.data(), 100) ? 1 : 0;
    ++next_picture;
  }
  return shown;
}

Pose2 truth_at(const Walk& walk, double t) {
  std::size_t i = 1;
  while (i + 1 < walk.frames.size() && walk.frames[i].time_s < t) ++i;
  const WalkFrame& a = walk.frames[i - 1];
  const WalkFrame& b = walk.frames[i];
  const auto share = static_cast<float>((t - a.time_s) / (b.time_s - a.time_s));
  return {a.truth.x + (b.truth.x - a.truth.x) * share, a.truth.y + (b.truth.y - a.truth.y) * share,
          wrap_angle(a.truth.theta + angle_difference(b.truth.theta, a.truth.theta) * share)};
}

int judge(const Walk& walk, const std::string& path, MonotonicNs begin) {
  std::ifstream in(path);
  std::string line;
  std::vector<float> errors;
  int reports = 0, frames = 0, wrong_half = 0, lines = 0;
  double latency = 0.0;
  while (std::getline(in, line)) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) continue;
    ++lines;
    const double t = to_seconds(json["t_ns"].get<MonotonicNs>() - begin);
    if (t < settle_s || t > walk.frames.back().time_s) continue;
    ++reports;
    frames += json["from_frame"].get<bool>() ? 1 : 0;
    latency += json["latency_ms"]["processing"].get<double>();
    if (json["pose"].is_null()) continue;
    const Pose2 truth = truth_at(walk, t);
    const float x = json["pose"]["x_m"].get<float>(), y = json["pose"]["y_m"].get<float>();
    const float error = std::hypot(x - truth.x, y - truth.y);
    const float mirrored = std::hypot(x + truth.x, y + truth.y);
    wrong_half += mirrored < error && mirrored < 0.4F ? 1 : 0;
    errors.push_back(error);
  }
  std::sort(errors.begin(), errors.end());
  const float median = errors.empty() ? 99.0F : errors[errors.size() / 2];
  const float p90 = errors.empty() ? 99.0F : errors[errors.size() * 9 / 10];
  std::printf(
      "robot: %d lines, %d in the walk, %d from pictures, %zu poses, median %.3f m, 90 %% %.3f m, wrong half %d, "
      "processing %.0f ms\n",
      lines, reports, frames, errors.size(), static_cast<double>(median), static_cast<double>(p90), wrong_half,
      frames > 0 ? latency / frames : 0.0);
  const bool good = frames > 30 && errors.size() * 10 > static_cast<std::size_t>(reports) * 8 && median <= 0.10F &&
                    static_cast<std::size_t>(wrong_half) * 20 < errors.size();
  std::printf("%s robot: median within 0.10 m, in the right half\n", good ? "PASS" : "FAIL");
  return good ? 0 : 1;
}

}  // namespace
}  // namespace touchline::vm

int main(int argc, char** argv) {
  using namespace touchline;
  using namespace touchline::vm;
  if (argc != 4) return 2;
  const std::string folder = argv[1];
  const Walk walk = read_walk(folder + "/walk.txt");
  std::ifstream pictures(folder + "/walk.yuyv", std::ios::binary);
  std::vector<std::uint8_t> first(picture_bytes);
  pictures.read(reinterpret_cast<char*>(first.data()), static_cast<std::streamsize>(first.size()));
  if (walk.frames.empty() || !pictures) return std::printf("FAIL no walk in %s\n", folder.c_str()), 1;
  Stage stage;
  stage.start = clock_now.now();
  if (!stage.set_up()) return 1;
  std::ofstream(argv[3]) << "ready\n";  // now the daemon may open its devices
  before_the_walk(stage, walk, first.data());
  const MonotonicNs begin = clock_now.now();
  const int shown = play(stage, walk, pictures, begin);
  std::printf("robot: %d of %zu pictures shown, light %s\n", shown, walk.frames.size(),
              stage.panel.line(5) ? "on" : "off");
  return judge(walk, argv[2], begin);
}
