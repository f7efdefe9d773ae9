// SPDX-License-Identifier: Apache-2.0
#include "tests/vm/fault_stage.h"

#include <fcntl.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/hal/gait_header.h"
#include "tests/vm/raw_serial.h"
#include "tests/vm/walk_file.h"

namespace touchline::vm {
namespace {

constexpr std::size_t picture_bytes = 640 * 480 * 2;
constexpr MonotonicNs tick_period = 20 * one_millisecond;
constexpr MonotonicNs picture_period = 200 * one_millisecond;
constexpr const char* camera_link = "/dev/robot-camera";

/// The text of the walk's file with another camera path: that of the link.
std::string robot_file(const std::string& path) {
  std::ifstream in(path);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const std::string by_name = "device = \"vivid\"";
  const std::size_t place = text.find(by_name);
  if (place != std::string::npos) text.replace(place, by_name.size(), "device = \"" + std::string(camera_link) + "\"");
  return text;
}

Seen parse(const std::string& line) {
  Seen seen;
  const auto json = nlohmann::json::parse(line, nullptr, false);
  if (!json.is_object()) return seen;
  for (const auto& fault : json["faults"]) seen.faults.insert(fault.get<std::string>());
  seen.pose = !json["pose"].is_null();
  seen.from_frame = json["from_frame"].get<bool>();
  seen.yaw_used = json["yaw_used"].get<bool>();
  seen.odometry_used = json["odometry_used"].get<bool>();
  if (seen.pose) seen.sigma_m = std::sqrt(json["covariance"][0].get<double>() + json["covariance"][2].get<double>());
  seen.camera_lost = json["health"]["camera"]["lost"].get<int>();
  return seen;
}

}  // namespace

FaultStage::FaultStage(std::string share) : share_(std::move(share)), file_("/tmp/robot.toml") {
  base_ = robot_file(share_ + "/robot.toml");
  const Walk walk = read_walk(share_ + "/walk.txt");
  std::ifstream pictures(share_ + "/walk.yuyv", std::ios::binary);
  picture_.resize(picture_bytes);
  pictures.read(reinterpret_cast<char*>(picture_.data()), static_cast<std::streamsize>(picture_bytes));
  for (std::size_t i = 0; i < picture_bytes; ++i) black_picture_.push_back(i % 2 == 0 ? 16 : 128);
  serial_ = open_raw("/dev/gait-controller");
  if (serial_ >= 0) ::fcntl(serial_, F_SETFL, O_NONBLOCK);
  ready_ = !walk.readings.empty() && pictures.good() && serial_ >= 0;
  if (!ready_) return;
  const WalkReading& first = walk.readings.front();
  true_yaw_ = first.yaw;
  height_ = first.height;
  pitch_ = first.pitch;
  roll_ = first.roll;
  start_ = next_tick_ = clock_.now();
}

bool FaultStage::plug_in_camera() {
  if (std::system("insmod /tmp/mods/vivid.ko $VIVID") != 0) return false;
  output_ = std::make_unique<VividOutput>();
  if (!output_->open()) return false;
  camera_ = vivid_node(false);
  return ::symlink(camera_.c_str(), camera_link) == 0;
}

/// The daemon lets go of the device when it learns of it; the module then can be taken out.
bool FaultStage::unplug_camera() {
  ::unlink(camera_link);
  if (output_ != nullptr) (void)control_camera("Disconnect", 1);
  output_.reset();
  for (int i = 0; i < 20; ++i) {
    if (std::system("rmmod vivid 2>/dev/null") == 0) return true;
    (void)play(0.2);
  }
  return false;
}

void FaultStage::write_file(const std::string& more) const { std::ofstream(file_) << base_ << more; }

void FaultStage::start_daemon(const std::string& more, int out) {
  write_file(more);
  newest_ = {};
  daemon_ = std::make_unique<test::ChildProcess>(std::vector<std::string>{share_ + "/touchline", "run", file_}, out);
}

void FaultStage::send_gait() {
  if (gait_mode == Gait::silent) return;
  touchline_gait gait{};
  gait.flags = static_cast<std::uint8_t>(TOUCHLINE_GAIT_HAS_CAMERA | TOUCHLINE_GAIT_STANDING | gait_flags);
  gait.boot_id = boot_id;
  gait.sequence = sequence_++;
  gait.time_us = static_cast<std::uint32_t>((clock_.now() - start_) / 1000);
  gait.x_m = walked_x;
  gait.camera_height_m = height_;
  gait.camera_pitch_rad = pitch_;
  gait.camera_roll_rad = roll_;
  std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
  encode_gait_in_c(&gait, frame);
  if (gait_mode == Gait::corrupt) frame[20] ^= 0x01;
  for (int i = 0; i < (gait_mode == Gait::doubled ? 2 : 1); ++i) (void)!::write(serial_, frame, sizeof frame);
}

void FaultStage::tick() {
  clock_.wait_until(next_tick_);
  const MonotonicNs now = clock_.now();
  while (next_tick_ <= now) next_tick_ += tick_period;
  if (imu_mode != Imu::silent) imu.send(yaw, imu_mode == Imu::garbage);
  send_gait();
  if (output_ != nullptr && now >= next_picture_) {
    next_picture_ = now + picture_period;
    (void)output_->show((black ? black_picture_ : picture_).data(), 0);
  }
  if (daemon_ != nullptr) (void)daemon_->collect(0);
}

bool FaultStage::listen(const std::function<bool(const Seen&)>& condition) {
  while (daemon_ != nullptr) {
    const std::optional<std::string> line = daemon_->take_line();
    if (!line) break;
    ++lines_;
    newest_ = parse(*line);
    if (condition(newest_)) return true;
  }
  return false;
}

std::optional<double> FaultStage::until(double seconds, const std::function<bool(const Seen&)>& condition) {
  const MonotonicNs begin = clock_.now();
  do {
    tick();
    if (listen(condition)) return to_seconds(clock_.now() - begin);
  } while (clock_.now() < begin + from_seconds(seconds));
  return {};
}

bool FaultStage::until_logged(double seconds, const std::string& text) {
  const auto logged = [&] { return daemon_->log().find(text) != std::string::npos; };
  for (const MonotonicNs end = clock_.now() + from_seconds(seconds); !logged() && clock_.now() < end;) (void)play(0.1);
  return logged();
}

int FaultStage::play(double seconds) {
  const int before = lines_;
  (void)until(seconds, [](const Seen&) { return false; });
  return lines_ - before;
}

}  // namespace touchline::vm
