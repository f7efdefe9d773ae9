// SPDX-License-Identifier: Apache-2.0
// The robot's program on the interfaces of hal alone: frames, odometry, yaw and buttons in, poses out. The demo, the
// daemon and the bare-metal port run this; they differ in their backends. No device is a single point of failure.
#pragma once

#include <cstdint>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/panel.h"
#include "loc/localizer.h"
#include "platform/robot/dead_reckoning.h"
#include "platform/robot/robot_report.h"
#include "platform/robot/sensors.h"
#include "vision/pipeline.h"

namespace touchline {

/// Null: the robot has none. All outlive the loop.
struct RobotDevices {
  Camera* camera = nullptr;  // required
  Imu* imu = nullptr;
  GaitLink* gait = nullptr;
  Panel* panel = nullptr;
  Clock* clock = nullptr;  // required
};

class RobotLoop {
 public:
  /// `memory` and `localizer` outlive the loop, which allocates nothing.
  RobotLoop(const RobotDevices& devices, const PipelineMemory& memory, Localizer& localizer)
      : devices_(devices), sensors_(devices.imu, devices.gait), pipeline_(memory), localizer_(localizer) {}

  /// invalid_argument: a value is out of range; `what` names it, when not null, and the loop must not run. A second
  /// call keeps pose and particles: thresholds may change while it runs.
  Status configure(const RobotConfig& config, const char** what = nullptr);

  /// One turn: reads all devices, waits at most a slice for a frame and works on it. Call it for ever.
  /// ok: `report` is new. not_ready: nothing to say this time. end_of_data: the camera's recording is over.
  Status turn(RobotReport& report, StageObserver* observer = nullptr);

  /// A report could not be written or sent.
  void note_output_failure() { events_.note(Fault::output, devices_.clock->now()); }
  /// The products of the frame last worked on; void before the first.
  [[nodiscard]] const VisionResult& vision() const { return vision_; }
  [[nodiscard]] bool goal_yaw_known() const { return goal_yaw_known_; }
  [[nodiscard]] float goal_yaw() const { return goal_yaw_; }
  /// How often the button has stored it.
  [[nodiscard]] std::uint32_t goal_yaw_presses() const { return goal_yaw_presses_; }
  /// What the IMU as it is now reads, in (-pi, pi], when the robot looks at the goal: good for a later start, too.
  [[nodiscard]] float goal_yaw_reading() const { return wrap_angle(goal_yaw_ - sensors_.yaw_offset()); }

 private:
  Status configure_parts(const RobotConfig& config, const char** what);
  void watch_clock(MonotonicNs now);
  void service_panel(MonotonicNs now);
  void on_button(ButtonPress press, MonotonicNs now);
  bool keep_camera_open(MonotonicNs now);
  Status work_on(const CameraFrame& frame, RobotReport& report, StageObserver* observer);
  bool is_usable(const CameraFrame& frame, MonotonicNs time);
  Status see(const CameraFrame& frame, MonotonicNs time, StageObserver* observer);
  Status localize(MonotonicNs time, RobotReport& report, StageObserver* observer);
  Motion motion_since(const PathPoint& anchor, const PathPoint& here) const;
  void reckon_to(MonotonicNs time);
  Status report_idle(MonotonicNs now, RobotReport& report);
  void finish(RobotReport& report, MonotonicNs now);
  [[nodiscard]] FaultSet faults(MonotonicNs now) const;
  [[nodiscard]] LedPattern led(const FaultSet& faults) const;
  void lose_pose();

  RobotDevices devices_;
  RobotConfig config_;
  Sensors sensors_;
  EventFaults events_;
  Pipeline pipeline_;
  Localizer& localizer_;
  VisionResult vision_;
  MonotonicNs last_turn_ = 0;

  Retry camera_retry_, panel_retry_;
  MonotonicNs last_arrival_ = 0;  // of a frame, or of the camera's opening
  MonotonicNs last_frame_ = 0;    // time of the newest frame that was used
  MonotonicNs last_used_ = 0;     // when that was
  std::uint64_t resets_ = 0;

  PoseEstimate estimate_;  // at `reckoned_to_`
  MonotonicNs reckoned_to_ = 0;
  PathPoint reckoned_path_;
  PathPoint localized_path_;  // at the localizer's last update
  CameraAttitude attitude_;
  MonotonicNs last_report_ = 0;
  std::uint64_t reports_ = 0;
  std::uint64_t frames_ = 0;
  float goal_yaw_ = 0.0F;
  std::uint32_t goal_yaw_presses_ = 0;

  Status camera_status_ = Status::not_ready;  // of the last open()
  bool configured_ = false;
  bool turned_ = false;
  bool camera_stalled_ = false;
  bool black_ = false;
  bool wrong_size_ = false;
  bool has_frame_ = false;
  bool has_localized_ = false;
  bool goal_yaw_known_ = false;
  bool moved_by_hand_ = false;  // since the localizer's last update
};

}  // namespace touchline
