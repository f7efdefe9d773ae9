// SPDX-License-Identifier: Apache-2.0
// A robot that stands on a field before one simulated picture, with devices that can be made to fail in every way that
// the README's table names. Time is a ManualClock's: it passes where a device or the loop waits.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "hal/mock/manual_clock.h"
#include "hal/mock/mock_panel.h"
#include "platform/robot/robot_loop.h"
#include "vision/pipeline_storage.h"

namespace touchline::test {

class TestCamera final : public Camera {
 public:
  enum class Mode { good, missing, stalled, damaged, black, wrong_size, refused };
  explicit TestCamera(ManualClock& clock);

  Mode mode = Mode::good;
  MonotonicNs period = 200 * one_millisecond;
  MonotonicNs back_in_time = 0;  // taken from the time stamps
  int lent = 0;

 private:
  Status do_open() override;
  void do_close() override;
  Result<CameraFrame> do_acquire(MonotonicNs deadline) override;
  Status do_release(const CameraFrame& frame) override;
  DeviceHealth do_health() const override { return health_; }

  ManualClock& clock_;
  DeviceHealth health_;
  MonotonicNs next_ = 0;
  std::uint64_t sequence_ = 0;
  std::vector<std::uint8_t> black_;
};

class TestImu final : public Imu {
 public:
  enum class Mode { good, missing, silent, garbage };
  explicit TestImu(ManualClock& clock) : clock_(clock) {}

  Mode mode = Mode::good;
  float yaw = 0.0F;   // as the device reads it
  bool tilt = false;  // the device has roll and pitch (both 0)

 private:
  Status do_open() override;
  void do_close() override { health_.open = false; }
  Result<ImuSample> do_read() override;
  DeviceHealth do_health() const override { return health_; }

  ManualClock& clock_;
  DeviceHealth health_;
  MonotonicNs next_ = 0;
};

class TestGait final : public GaitLink {
 public:
  enum class Mode { good, missing, silent, corrupt };
  explicit TestGait(ManualClock& clock) : clock_(clock) {}

  Mode mode = Mode::good;
  GaitSample state;          // sent again and again
  float ahead_speed = 0.0F;  // m/s, adds to state.odometry

 private:
  Status do_open() override;
  void do_close() override { health_.open = false; }
  Result<GaitSample> do_read() override;
  DeviceHealth do_health() const override { return health_; }

  ManualClock& clock_;
  DeviceHealth health_;
  MonotonicNs next_ = 0;
};

/// The picture, where it was taken from, and the configuration that fits.
struct Scene {
  std::vector<std::uint8_t> rgb;
  int width = 0, height = 0;
  Pose2 truth;
  RobotConfig config;
};
/// Drawn once a program.
const Scene& scene();

class TestRobot {
 public:
  TestRobot();

  /// Runs for so long; the last report is in `report`, all of them are counted.
  void run(MonotonicNs duration);
  /// Metres from the truth; huge without a pose.
  [[nodiscard]] float error() const;
  [[nodiscard]] float sigma() const;  // metres, of x and y together
  [[nodiscard]] bool has(Fault fault) const { return report.faults.has(fault); }

  ManualClock clock{100 * one_second};
  TestCamera camera{clock};
  TestImu imu{clock};
  TestGait gait{clock};
  MockPanel panel;
  std::unique_ptr<PipelineStorage<>> storage = std::make_unique<PipelineStorage<>>();
  std::unique_ptr<Localizer> localizer = std::make_unique<Localizer>();
  RobotLoop loop;
  RobotReport report;
  int reports = 0;
};

}  // namespace touchline::test
