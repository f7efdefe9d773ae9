// SPDX-License-Identifier: Apache-2.0
// A camera that plays a script, and one that writes down what another camera was asked.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "hal/camera.h"
#include "hal/mock/call_log.h"
#include "hal/mock/manual_clock.h"
#include "hal/mock/script.h"

namespace touchline {

/// Lends scripted frames and keeps the contract: one that is not open is disconnected, a failure to wait costs the time
/// up to the deadline, and a buffer that is not lent cannot be released.
class ScriptedCamera final : public Camera {
 public:
  explicit ScriptedCamera(ManualClock& clock, std::uint32_t buffers = 4) : clock_(clock), buffers_(buffers) {}

  Script<CameraFrame> frames{Status::timeout};
  OpenScript opens;

  /// A frame of one colour, kept by the mock, in the form that the script takes. `grey` fills every byte.
  CameraFrame make_frame(int width, int height, std::uint8_t grey, MonotonicNs time, std::uint64_t sequence) {
    const auto row = static_cast<std::size_t>(width) * 3;
    pixels_.emplace_back(row * static_cast<std::size_t>(height), grey);
    CameraFrame frame;
    frame.image = {PixelFormat::rgb24, pixels_.back().data(), width, height, width * 3};
    frame.time = time;
    frame.sequence = sequence;
    return frame;
  }
  [[nodiscard]] std::size_t lent() const { return lent_.size(); }

 private:
  Status do_open() override {
    if (health_.open) return Status::ok;
    const Status status = opens.next();
    health_.open = status == Status::ok;
    if (health_.open) ++health_.opened;
    return note(status);
  }
  void do_close() override {
    health_.open = false;
    lent_.clear();
  }
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override {
    if (!health_.open) return note(Status::disconnected);
    if (lent_.size() == buffers_) return note(Status::capacity);
    const Result<CameraFrame> step = frames.next();
    if (!step.ok()) {
      clock_.advance_to(deadline);
      if (step.status() == Status::disconnected) do_close();
      return note(step.status());
    }
    CameraFrame frame = step.value();
    clock_.advance_to(frame.time);
    frame.buffer = next_buffer_++;
    lent_.push_back(frame.buffer);
    health_.last_datum = frame.time;
    health_.lost += frame.lost;
    health_.skipped += frame.skipped;
    ++(frame.error ? health_.corrupt : health_.received);
    return frame;
  }
  Status do_release(const CameraFrame& frame) override {
    if (!health_.open) return Status::disconnected;
    for (std::size_t i = 0; i < lent_.size(); ++i) {
      if (lent_[i] != frame.buffer) continue;
      lent_.erase(lent_.begin() + static_cast<std::ptrdiff_t>(i));
      return Status::ok;
    }
    return Status::invalid_argument;
  }
  DeviceHealth do_health() const override { return health_; }
  Status note(Status status) {
    if (status != Status::ok) health_.last_error = status;
    return status;
  }

  ManualClock& clock_;
  std::uint32_t buffers_;
  std::uint32_t next_buffer_ = 0;
  std::vector<std::uint32_t> lent_;
  std::vector<std::vector<std::uint8_t>> pixels_;
  DeviceHealth health_;
};

/// Passes every call on and writes it down.
class RecordingCamera final : public Camera {
 public:
  explicit RecordingCamera(Camera& inner) : inner_(inner) {}
  CallLog log;

 private:
  Status do_open() override {
    const Status status = inner_.open();
    log.add("open", status);
    return status;
  }
  void do_close() override {
    inner_.close();
    log.add("close");
  }
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override {
    const Result<CameraFrame> frame = inner_.acquire(deadline);
    log.add("acquire", frame.status());
    return frame;
  }
  Status do_release(const CameraFrame& frame) override {
    const Status status = inner_.release(frame);
    log.add("release", status);
    return status;
  }
  DeviceHealth do_health() const override { return inner_.health(); }

  Camera& inner_;
};

}  // namespace touchline
