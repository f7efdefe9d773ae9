// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/sim_devices.h"

#include <algorithm>

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

MonotonicNs clock_time(double simulated_s) { return one_second + from_seconds(simulated_s); }

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

void SimRobot::push_readings() {
  const WalkScenarioOptions& options = walk_.options();
  for (const SimReading& reading : walk_.readings()) {
    ImuSample imu;
    imu.time = clock_time(reading.time_s);
    imu.yaw = reading.yaw;
    imu.has_tilt = true;
    imu.pitch = reading.mount.pitch - options.walk.camera.pitch;
    imu.roll = reading.mount.roll - options.walk.camera.roll;
    if (options.yaw) imu_.push(imu);
    GaitSample gait;
    gait.time = imu.time;
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
    gait_.push(gait);
  }
}

Status SimRobot::advance(MonotonicNs deadline, std::vector<std::uint8_t>& pixels, CameraFrame& out) {
  const double next_s = static_cast<double>(next_index_) / static_cast<double>(walk_.options().frames_per_second);
  if (next_s > seconds_) return Status::end_of_data;
  if (clock_time(next_s) > deadline && clock_.now() < clock_time(next_s)) {
    clock_.advance_to(deadline);
    return Status::timeout;
  }
  frame_ = walk_.next();
  next_index_ += 1;
  push_readings();
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
  out.time = clock_time(next_s);
  out.sequence = static_cast<std::uint64_t>(frame_.index);
  clock_.advance_to(out.time);
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
