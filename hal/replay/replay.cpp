// SPDX-License-Identifier: Apache-2.0
#include "hal/replay/replay.h"

#include <string>

#include "platform/host/host_error.h"

namespace touchline {
namespace {

/// The first frame comes this long after the start, so that the loop has opened all devices.
constexpr MonotonicNs lead = 20 * one_millisecond;
/// Between the last frame of a loop and the first of the next; data sets have 10 to 50 frames a second.
constexpr MonotonicNs loop_gap = 100 * one_millisecond;

Status opened(DeviceHealth& health) {
  if (!health.open) ++health.opened;
  health.open = true;
  return Status::ok;
}

void check_times(const host::DataSet& set) {
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    const host::DataFrame& frame = set.frames[i];
    const std::string where = (set.folder / "frames.jsonl").string() + ":" + std::to_string(frame.line);
    if (!frame.has_time) throw host::HostError(where + ": t_s is missing; a frame that is played needs its time");
    if (i > 0 && frame.time_s <= set.frames[i - 1].time_s) {
      throw host::HostError(where + ": t_s does not grow; sort the frames by time");
    }
  }
}

}  // namespace

Replay::Replay(const std::filesystem::path& folder, Clock& clock, const ReplayOptions& options)
    : set_(host::read_dataset(folder)), clock_(clock), options_(options), start_(clock.now() + lead) {
  if (set_.frames.empty()) throw host::HostError(folder.string() + ": no frames to play; add lines to frames.jsonl");
  check_times(set_);
  std::size_t bytes = 0;
  for (const host::DataFrame& frame : set_.frames) {
    images_.push_back(host::read_frame_image(frame));
    bytes += images_.back().rgb.size();
    if (bytes > options.max_bytes) {
      throw host::HostError(folder.string() + ": the images take more than " +
                            std::to_string(options.max_bytes >> 20U) + " MiB of memory; play fewer frames");
    }
    if (images_.back().width != images_.front().width || images_.back().height != images_.front().height) {
      throw host::HostError(frame.path.string() + ": has another size than the first image; one camera has one size");
    }
  }
  round_ = from_seconds(set_.frames.back().time_s - set_.frames.front().time_s) + loop_gap;
}

MonotonicNs Replay::time_of(std::uint64_t number) const {
  const auto loop = static_cast<MonotonicNs>(number / set_.frames.size());
  return start_ + loop * round_ + from_seconds(frame(number).time_s - set_.frames.front().time_s);
}

Status Replay::ReplayCamera::do_open() { return opened(health_); }

Result<CameraFrame> Replay::ReplayCamera::do_acquire(MonotonicNs deadline) {
  if (!health_.open) return Status::disconnected;
  if (next_ >= owner_.total()) return health_.last_error = Status::end_of_data;
  const MonotonicNs time = owner_.time_of(next_);
  if (time > deadline) {
    owner_.clock_.wait_until(deadline);
    return Status::timeout;
  }
  owner_.clock_.wait_until(time);
  CameraFrame result;
  while (next_ + 1 < owner_.total() && owner_.time_of(next_ + 1) <= owner_.clock_.now()) {
    ++next_;
    ++result.skipped;
  }
  result.image = owner_.images_[static_cast<std::size_t>(next_ % owner_.images_.size())].view();
  result.time = owner_.time_of(next_);
  result.sequence = next_;
  owner_.current_ = next_++;
  ++lent_;
  ++health_.received;
  health_.skipped += result.skipped;
  health_.last_datum = result.time;
  return result;
}

Status Replay::ReplayCamera::do_release(const CameraFrame&) {
  if (!health_.open) return Status::disconnected;
  if (lent_ == 0) return Status::invalid_argument;
  --lent_;
  return Status::ok;
}

Status Replay::ReplayImu::do_open() { return opened(health_); }

Result<ImuSample> Replay::ReplayImu::do_read() {
  if (!health_.open) return Status::disconnected;
  while (next_ < owner_.total() && !owner_.frame(next_).has_yaw) ++next_;
  if (next_ >= owner_.total()) return Status::end_of_data;
  if (owner_.time_of(next_) > owner_.clock_.now()) return Status::not_ready;
  const float yaw = owner_.frame(next_).yaw;
  yaw_ = has_yaw_ ? yaw_ + angle_difference(yaw, yaw_) : yaw;
  has_yaw_ = true;
  ImuSample sample;
  sample.time = owner_.time_of(next_++);
  sample.yaw = yaw_;
  ++health_.received;
  health_.last_datum = sample.time;
  return sample;
}

Status Replay::ReplayGait::do_open() { return opened(health_); }

Result<GaitSample> Replay::ReplayGait::do_read() {
  if (!health_.open) return Status::disconnected;
  if (next_ >= owner_.total()) return Status::end_of_data;
  if (owner_.time_of(next_) > owner_.clock_.now()) return Status::not_ready;
  const host::DataFrame& frame = owner_.frame(next_);
  // The first frame's step tells of a way that nobody saw.
  if (frame.has_odometry && next_ % owner_.set_.frames.size() != 0) odometry_ = compose(odometry_, frame.odometry);
  GaitSample sample;
  sample.time = owner_.time_of(next_);
  sample.sequence = static_cast<std::uint32_t>(next_++);
  sample.boot_id = 1;
  sample.odometry = odometry_;
  sample.has_camera_attitude = true;
  sample.camera_height = frame.camera.mount.height;
  sample.camera_pitch = frame.camera.mount.pitch;
  sample.camera_roll = frame.camera.mount.roll;
  ++health_.received;
  health_.last_datum = sample.time;
  return sample;
}

}  // namespace touchline
