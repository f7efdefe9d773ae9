// SPDX-License-Identifier: Apache-2.0
// The IMU and the gait link behind one door: kept open, read, and asked for what held at the time of a frame.
#pragma once

#include <cstdint>

#include "hal/camera_attitude.h"
#include "hal/gait_link.h"
#include "hal/imu.h"
#include "hal/odometry_history.h"
#include "hal/yaw_history.h"
#include "platform/robot/event_faults.h"
#include "platform/robot/robot_config.h"

namespace touchline {

/// The path walked up to a time.
struct PathPoint {
  Pose2 pose;              // only differences mean something
  double unknown_s = 0.0;  // seconds since start in which the motion is not known
  bool known = false;      // the odometry covers this time
  bool has_yaw = false;    // the IMU covers it
  float yaw = 0.0F;        // continuous, radians
};

class Sensors {
 public:
  /// Either may be null: the robot has none.
  Sensors(Imu* imu, GaitLink* gait) : imu_(imu), gait_(gait) {}
  void configure(const RobotConfig& config);

  /// Opens what is missing, reads all that waits.
  void service(MonotonicNs now, EventFaults& events);

  /// False when the IMU has said nothing about this time.
  bool yaw_at(MonotonicNs time, float& yaw) const;
  /// What yaw_at() has more than the device reads.
  [[nodiscard]] float yaw_offset() const { return yaw_.offset(); }
  [[nodiscard]] PathPoint path_at(MonotonicNs time) const;
  [[nodiscard]] CameraAttitude attitude_at(MonotonicNs time) const;
  /// The gait link tells the camera's attitude, but has just missed some frames: a head that sways is somewhere else by
  /// now, and a picture taken with the old attitude would mislead. False again once the link is silent for good.
  [[nodiscard]] bool attitude_missed(MonotonicNs time) const;

  [[nodiscard]] bool fallen() const { return gait_fresh_ && state_.fallen; }
  [[nodiscard]] bool lifted() const { return gait_fresh_ && state_.lifted; }
  /// There is a gait link, but nothing of it can be used at the moment: silent, missing, or implausible.
  [[nodiscard]] bool gait_lost() const { return gait_ != nullptr && !gait_fresh_; }
  /// States of both devices, by name.
  void add_faults(FaultSet& faults) const;
  [[nodiscard]] DeviceHealth imu_health() const { return imu_ != nullptr ? imu_->health() : DeviceHealth{}; }
  [[nodiscard]] DeviceHealth gait_health() const { return gait_ != nullptr ? gait_->health() : DeviceHealth{}; }
  [[nodiscard]] std::uint32_t yaw_jumps() const { return yaw_.jumps(); }
  [[nodiscard]] std::uint32_t odometry_jumps() const { return odometry_.jumps(); }

 private:
  /// What the gait controller says of camera and head, for one time.
  struct HeadState {
    bool has_camera = false, has_head = false;
    float height = 0, pitch = 0, roll = 0, pan = 0, tilt = 0;
  };
  friend HeadState interpolate(const HeadState& from, const HeadState& to, float share);

  /// More waits only after a stall, and then the rest is read in the next turn.
  static constexpr int max_reads = 256;
  /// A humanoid's head sways with a period of half a second and more: in this time it hardly moves.
  static constexpr MonotonicNs min_attitude_age = 40 * one_millisecond;
  static constexpr std::size_t head_capacity = 100;  // half a second of a 200 Hz link

  void service_imu(MonotonicNs now, EventFaults& events);
  void service_gait(MonotonicNs now, EventFaults& events);
  void take(const ImuSample& sample, MonotonicNs now, EventFaults& events);
  void take(const GaitSample& sample, MonotonicNs now, EventFaults& events);

  Imu* imu_;
  GaitLink* gait_;
  RobotConfig config_;
  Retry imu_retry_, gait_retry_;

  YawHistory yaw_;
  MonotonicNs imu_heard_ = 0;  // when the newest sample was read
  float theta_at_yaw_ = 0.0F;  // the path's theta when the newest yaw was taken
  std::uint32_t imu_corrupt_ = 0;

  OdometryHistory odometry_;
  History<HeadState, head_capacity> head_;
  MonotonicNs head_period_ = 0;  // of the link's samples, smoothed
  GaitSample state_;
  bool has_state_ = false;
  bool gait_fresh_ = false;
  bool imu_fresh_ = false;   // its newest sample may be used
  bool imu_silent_ = false;  // it has said nothing for too long, since its opening or its last sample
  bool gait_silent_ = false;
  MonotonicNs gait_heard_ = 0;  // when the newest sample was read, and
  MonotonicNs gait_used_ = 0;   // the newest that was plausible
  bool path_broken_ = false;    // the newest sample was a jump, not yet known to stay
  double unknown_s_ = 0.0;
  std::uint32_t gait_corrupt_ = 0;
};

}  // namespace touchline
