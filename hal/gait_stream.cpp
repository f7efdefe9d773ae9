// SPDX-License-Identifier: Apache-2.0
// Order and time of gait frames.
#include "hal/gait_stream.h"

namespace touchline {
namespace {

/// Two quartzes of 100 ppm each.
constexpr MonotonicNs drift_ppm = 200;
/// Frames later than this, so many in a row, come from a controller that stood still (a debugger). Fewer are a burst
/// that waited in the kernel while this program was busy: its buffer of 4 KiB holds 93.
constexpr MonotonicNs max_late = one_second;
constexpr std::uint32_t late_limit = 150;
/// A frame this far back in the sequence did not overtake others on the line: the controller counts from the start
/// again.
constexpr std::int32_t reorder_window = 32;
/// So many frames of the boot before cannot be stragglers: the controller has restarted with its old number.
constexpr std::uint32_t straggler_limit = 8;

}  // namespace

MonotonicNs ControllerClock::to_local(std::uint32_t controller_us, MonotonicNs arrival) {
  if (!started_) {
    started_ = true;
    controller_ = 0;
    offset_ = arrival;
    late_ = 0;
    last_local_ = arrival - 1;
  } else {
    const MonotonicNs step = static_cast<MonotonicNs>(controller_us - last_us_) * 1000;  // right across the wrap
    controller_ += step;
    offset_ += step / 1'000'000 * drift_ppm;
    follow(arrival - controller_);
  }
  last_us_ = controller_us;
  const MonotonicNs local = controller_ + offset_;
  last_local_ = local > last_local_ ? local : last_local_ + 1;
  return last_local_;
}

void ControllerClock::follow(MonotonicNs seen) {
  if (seen - offset_ <= max_late) {
    late_ = 0;
    if (seen < offset_) offset_ = seen;
    return;
  }
  late_offset_ = late_ == 0 || seen < late_offset_ ? seen : late_offset_;
  if (++late_ < late_limit) return;
  offset_ = late_offset_;
  late_ = 0;
}

Result<GaitSample> GaitStream::push(std::uint8_t byte, MonotonicNs arrival) {
  const Result<GaitFrame> frame = decoder_.push(byte);
  if (frame.ok()) return accept(frame.value(), arrival);
  if (frame.status() != Status::not_ready) {
    ++counts_.corrupt;
    counts_.last_error = frame.status();
  }
  return frame.status();
}

bool GaitStream::is_restart(const GaitSample& sample) {
  if (sample.boot_id == boot_id_) {
    frames_of_old_boot_ = 0;
    return static_cast<std::int32_t>(sample.sequence - last_sequence_) < -reorder_window;
  }
  const bool of_old_boot = has_boot_before_ && sample.boot_id == boot_id_before_;
  return !of_old_boot || ++frames_of_old_boot_ >= straggler_limit;
}

Result<GaitSample> GaitStream::accept(const GaitFrame& frame, MonotonicNs arrival) {
  GaitSample sample = frame.sample;
  if (!has_last_ || is_restart(sample)) {
    if (has_last_) {
      ++counts_.restarts;
      boot_id_before_ = boot_id_;
      has_boot_before_ = boot_id_ != sample.boot_id;
    }
    has_last_ = true;
    frames_of_old_boot_ = 0;
    clock_.reset();
  } else {
    const auto ahead = static_cast<std::int32_t>(sample.sequence - last_sequence_);
    if (sample.boot_id != boot_id_ || ahead <= 0) {
      ++counts_.stale;
      counts_.last_error = Status::stale;
      return Status::stale;
    }
    counts_.lost += static_cast<std::uint32_t>(ahead) - 1;
  }
  boot_id_ = sample.boot_id;
  last_sequence_ = sample.sequence;
  sample.time = clock_.to_local(frame.time_us, arrival) - transport_;
  ++counts_.received;
  counts_.last_datum = sample.time;
  return sample;
}

}  // namespace touchline
