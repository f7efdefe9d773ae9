// SPDX-License-Identifier: Apache-2.0
// The simulated robot behind the interfaces of hal: camera, IMU, gait link, panel and clock. Simulated time passes when
// a frame is waited for and not otherwise, so a run is the same however fast the machine is.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/gait_link.h"
#include "hal/imu.h"
#include "hal/panel.h"
#include "platform/host/sim/scenario.h"

namespace touchline::sim {

class SimClock final : public Clock {
 public:
  void advance_to(MonotonicNs time) { now_ = time > now_ ? time : now_; }

 private:
  MonotonicNs do_now() override { return now_; }
  void do_wait_until(MonotonicNs time) override { advance_to(time); }
  MonotonicNs now_ = one_second;  // simulated time 0
};

class SimImuDevice final : public Imu {
 public:
  void push(const ImuSample& sample);

 private:
  Status do_open() override;
  void do_close() override { health_.open = false; }
  Result<ImuSample> do_read() override;
  DeviceHealth do_health() const override { return health_; }
  std::deque<ImuSample> waiting_;
  DeviceHealth health_;
};

class SimGaitLink final : public GaitLink {
 public:
  void push(const GaitSample& sample);

 private:
  Status do_open() override;
  void do_close() override { health_.open = false; }
  Result<GaitSample> do_read() override;
  DeviceHealth do_health() const override { return health_; }
  std::deque<GaitSample> waiting_;
  DeviceHealth health_;
};

/// Presses are pushed by whoever runs the simulation; the light's pattern can be looked at.
class SimPanel final : public Panel {
 public:
  void push(const ButtonEvent& event) { waiting_.push_back(event); }
  [[nodiscard]] LedPattern pattern() const { return pattern_; }

 private:
  Status do_open() override;
  void do_close() override { health_.open = false; }
  Result<ButtonEvent> do_poll(MonotonicNs now) override;
  void do_show(LedPattern pattern) override { pattern_ = pattern; }
  DeviceHealth do_health() const override { return health_; }
  std::deque<ButtonEvent> waiting_;
  LedPattern pattern_ = LedPattern::off;
  DeviceHealth health_;
};

class SimRobot;

/// Draws a frame when it is asked for one; lends up to `buffers` at a time.
class SimCamera final : public Camera {
 public:
  explicit SimCamera(SimRobot& robot) : robot_(robot) {}
  static constexpr std::uint32_t buffers = 4;

 private:
  Status do_open() override;
  void do_close() override;
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override;
  Status do_release(const CameraFrame& frame) override;
  DeviceHealth do_health() const override { return health_; }

  SimRobot& robot_;
  std::vector<std::uint8_t> pixels_[buffers];
  bool lent_[buffers] = {};
  DeviceHealth health_;
};

/// One simulated robot with all its devices. Ends after `seconds` of simulated time (end_of_data from the camera).
/// A kidnap takes 0.6 s of device time without a frame, in which the IMU feels the turn and the gait reports no step.
class SimRobot {
 public:
  SimRobot(const WalkScenarioOptions& options, double seconds, PixelFormat format = PixelFormat::rgb24);
  [[nodiscard]] bool ready() const { return walk_.ready(); }

  [[nodiscard]] SimCamera& camera() { return camera_; }
  [[nodiscard]] SimImuDevice& imu() { return imu_; }
  [[nodiscard]] SimGaitLink& gait() { return gait_; }
  [[nodiscard]] SimPanel& panel() { return panel_; }
  [[nodiscard]] SimClock& clock() { return clock_; }
  /// The frame last handed out, with its truth; its image is not valid here.
  [[nodiscard]] const SimFrame& truth() const { return frame_; }
  [[nodiscard]] WalkScenario& walk() { return walk_; }

 private:
  friend class SimCamera;
  struct Reading {
    ImuSample imu;
    GaitSample gait;
  };
  /// Goes on to the next frame, unless that is after `deadline` or the end.
  Status advance(MonotonicNs deadline, std::vector<std::uint8_t>& pixels, CameraFrame& out);
  [[nodiscard]] MonotonicNs time_at(double simulated_s) const;
  void take_reading(const SimReading& reading, MonotonicNs time);
  void take_readings();
  void carry(const SimReading& to);
  void advance_clock(MonotonicNs to);

  WalkScenario walk_;
  double seconds_;
  PixelFormat format_;
  SimFrame frame_;
  int next_index_ = 0;
  bool drawn_ = false;       // frame_ is the next one, but not due yet
  std::deque<Reading> due_;  // that the devices have not said yet
  SimReading last_reading_;
  float last_reading_yaw_ = 0.0F;  // of the reading before
  MonotonicNs carried_ = 0;        // device time that kidnaps have taken; the truth's time leaves it out
  std::uint32_t samples_ = 0;
  std::vector<std::uint8_t> rgb_;
  SimClock clock_;
  SimCamera camera_{*this};
  SimImuDevice imu_;
  SimGaitLink gait_;
  SimPanel panel_;
};

}  // namespace touchline::sim
