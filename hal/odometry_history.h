// SPDX-License-Identifier: Apache-2.0
// The gait's odometry as one unbroken path: across restarts of the controller and without implausible jumps, ready to
// be asked for any time of the recent past.
#pragma once

#include <cstdint>

#include "hal/gait_link.h"
#include "hal/history.h"

namespace touchline {

/// What a humanoid can do at most; more within the time between two samples is a fault of the link, not a step.
struct MotionLimits {
  float speed = 2.0F;              // m/s
  float turn_rate = radians(360);  // rad/s
  float slack = 0.05F;             // m: a sway of the torso, and rounding
  float turn_slack = radians(6);   // rad
};

class OdometryHistory {
 public:
  explicit OdometryHistory(const MotionLimits& limits = {}) : limits_(limits) {}

  /// Takes the next sample. ok: it lengthens the path. invalid_argument: not finite. corrupt: an implausible jump: it
  /// is no step; if the next sample agrees with it, the path goes on from there. stale: not newer than the newest.
  Status push(const GaitSample& sample);

  /// Where the robot was at `time` on the path; only differences mean something. Statuses of History::at().
  [[nodiscard]] Result<Pose2> at(MonotonicNs time) const { return path_.at(time, max_ahead); }
  /// The robot's step between two times: robot_then_from_robot_now.
  [[nodiscard]] Result<Pose2> step(MonotonicNs from, MonotonicNs to) const;
  [[nodiscard]] bool empty() const { return path_.empty(); }
  [[nodiscard]] MonotonicNs newest_time() const { return path_.newest_time(); }
  [[nodiscard]] const Pose2& newest() const { return path_.newest(); }
  [[nodiscard]] std::uint32_t jumps() const { return jumps_; }

 private:
  /// Half a second of a 200 Hz link: frames are never that late.
  static constexpr std::size_t capacity = 100;
  /// A frame may be younger than the newest sample by a period of a slow link.
  static constexpr MonotonicNs max_ahead = 50 * one_millisecond;

  [[nodiscard]] bool plausible(const GaitSample& from, const GaitSample& to) const;

  MotionLimits limits_;
  History<Pose2, capacity> path_;
  bool has_last_ = false;
  GaitSample last_;  // the newest sample that was believed
  bool has_odd_ = false;
  GaitSample odd_;  // the newest sample if it was not
  std::uint32_t jumps_ = 0;
};

}  // namespace touchline
