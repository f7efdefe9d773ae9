// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/sim_devices.h"

#include <algorithm>
#include <span>

#include "platform/core/elementary.h"

namespace touchline::sim {
namespace {

Status opened(DeviceHealth& health) {
  if (!health.open) ++health.opened;
  health.open = true;
  return Status::ok;
}

/// The oldest datum of a queue, by the rules that all readers share.
template <typename T>
Result<T> take(std::deque<T>& waiting, DeviceHealth& health) {
  if (!health.open) return Status::disconnected;
  if (waiting.empty()) return Status::not_ready;
  const T oldest = waiting.front();
  waiting.pop_front();
  ++health.received;
  health.last_datum = oldest.time;
  return oldest;
}

/// How long a hand takes to carry the robot elsewhere, and how often the devices report meanwhile. No IMU would believe
/// half a turn between two of its readings.
constexpr MonotonicNs carrying = 600 * one_millisecond;
constexpr int readings_while_carried = 30;

/// The reading after which the robot was somewhere else: the largest turn between two.
std::size_t first_after_kidnap(std::span<const SimReading> readings, float yaw_before) {
  std::size_t found = 0;
  float largest = -1.0F;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const float turn = math::abs(readings[i].yaw - yaw_before);
    if (turn > largest) {
      largest = turn;
      found = i;
    }
    yaw_before = readings[i].yaw;
  }
  return found;
}

}  // namespace

Status SimImuDevice::do_open() { return opened(health_); }
Status SimGaitLink::do_open() { return opened(health_); }
Status SimPanel::do_open() { return opened(health_); }
Result<ImuSample> SimImuDevice::do_read() { return take(waiting_, health_); }
Result<GaitSample> SimGaitLink::do_read() { return take(waiting_, health_); }

Result<ButtonEvent> SimPanel::do_poll(MonotonicNs now) {
  if (health_.open && !waiting_.empty() && waiting_.front().time > now) return Status::not_ready;
  return take(waiting_, health_);
}

void SimImuDevice::push(const ImuSample& sample) {
  if (health_.open) waiting_.push_back(sample);
}

void SimGaitLink::push(const GaitSample& sample) {
  if (health_.open) waiting_.push_back(sample);
}

SimRobot::SimRobot(const WalkScenarioOptions& options, double seconds, PixelFormat format)
    : walk_(options), seconds_(seconds), format_(format) {}

MonotonicNs SimRobot::time_at(double simulated_s) const { return one_second + from_seconds(simulated_s) + carried_; }

void SimRobot::take_reading(const SimReading& reading, MonotonicNs time) {
  const WalkScenarioOptions& options = walk_.options();
  ImuSample imu;
  imu.time = time;
  imu.yaw = reading.yaw;
  imu.has_tilt = true;
  imu.pitch = reading.mount.pitch - options.walk.camera.pitch;
  imu.roll = reading.mount.roll - options.walk.camera.roll;
  GaitSample gait;
  gait.time = time;
  gait.sequence = samples_++;
  gait.boot_id = 1;
  gait.odometry = reading.odometry;
  gait.has_camera_attitude = true;
  gait.camera_height = reading.mount.height;
  gait.camera_pitch = reading.mount.pitch;
  gait.camera_roll = reading.mount.roll;
  gait.support = SupportFoot::unknown;
  gait.walking = reading.activity == Activity::walking || reading.activity == Activity::turning;
  gait.standing = reading.activity == Activity::halted;
  gait.fallen = reading.activity == Activity::fallen;
  gait.lifted = reading.activity == Activity::lifted;
  due_.push_back({imu, gait});
  last_reading_ = reading;
}

/// The hand turns the robot evenly; its feet do not move.
void SimRobot::carry(const SimReading& to) {
  SimReading on_the_way = last_reading_;
  const MonotonicNs start = time_at(last_reading_.time_s);
  for (int i = 1; i <= readings_while_carried; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(readings_while_carried);
    on_the_way.yaw = last_reading_yaw_ + (to.yaw - last_reading_yaw_) * share;
    take_reading(on_the_way, start + carrying * i / readings_while_carried);
  }
  carried_ += carrying;
}

void SimRobot::take_readings() {
  const auto readings = walk_.readings();
  const std::size_t kidnap = frame_.kidnapped ? first_after_kidnap(readings, last_reading_.yaw) : readings.size();
  for (std::size_t i = 0; i < readings.size(); ++i) {
    last_reading_yaw_ = last_reading_.yaw;
    if (i == kidnap) carry(readings[i]);
    take_reading(readings[i], time_at(readings[i].time_s));
  }
}

/// Time goes on, and the devices say what is due.
void SimRobot::advance_clock(MonotonicNs to) {
  clock_.advance_to(to);
  while (!due_.empty() && due_.front().imu.time <= clock_.now()) {
    if (walk_.options().yaw) imu_.push(due_.front().imu);
    gait_.push(due_.front().gait);
    due_.pop_front();
  }
}

Status SimRobot::advance(MonotonicNs deadline, std::vector<std::uint8_t>& pixels, CameraFrame& out) {
  const double next_s = static_cast<double>(next_index_) / static_cast<double>(walk_.options().frames_per_second);
  if (next_s > seconds_) return Status::end_of_data;
  const auto is_late = [&] { return time_at(next_s) > deadline && clock_.now() < time_at(next_s); };
  if (!drawn_ && !is_late()) {
    frame_ = walk_.next();
    drawn_ = true;
    take_readings();  // of a kidnap: the frame is later than was thought
  }
  if (is_late()) {
    advance_clock(deadline);
    return Status::timeout;
  }
  next_index_ += 1;
  drawn_ = false;
  rgb_.assign(frame_.image.data,
              frame_.image.data + static_cast<std::ptrdiff_t>(frame_.image.stride_bytes) * frame_.image.height);
  const int width = frame_.image.width;
  const int height = frame_.image.height;
  frame_.image = {};
  if (format_ == PixelFormat::rgb24) {
    pixels.swap(rgb_);
  } else {
    convert_rgb24(rgb_, width, height, format_, pixels);
  }
  out = {};
  out.image = {format_, pixels.data(), width, height, width * bytes_per_pixel(format_)};
  out.time = time_at(next_s);
  out.sequence = static_cast<std::uint64_t>(frame_.index);
  advance_clock(out.time);
  return Status::ok;
}

Status SimCamera::do_open() {
  if (!robot_.ready()) return Status::unsupported;
  return opened(health_);
}

void SimCamera::do_close() {
  health_.open = false;
  std::fill(std::begin(lent_), std::end(lent_), false);
}

Result<CameraFrame> SimCamera::do_acquire(MonotonicNs deadline) {
  if (!health_.open) return Status::disconnected;
  const auto* free = std::find(std::begin(lent_), std::end(lent_), false);
  if (free == std::end(lent_)) return Status::capacity;
  const auto slot = static_cast<std::uint32_t>(free - std::begin(lent_));
  CameraFrame frame;
  const Status status = robot_.advance(deadline, pixels_[slot], frame);
  if (status != Status::ok) {
    health_.last_error = status;
    return status;
  }
  frame.buffer = slot;
  lent_[slot] = true;
  ++health_.received;
  health_.last_datum = frame.time;
  return frame;
}

Status SimCamera::do_release(const CameraFrame& frame) {
  if (!health_.open) return Status::disconnected;
  if (frame.buffer >= buffers || !lent_[frame.buffer]) return Status::invalid_argument;
  lent_[frame.buffer] = false;
  return Status::ok;
}

}  // namespace touchline::sim
