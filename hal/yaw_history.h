// SPDX-License-Identifier: Apache-2.0
// The IMU's attitude over the recent past: yaw as one unbroken curve, tilt beside it, implausible jumps taken out.
#pragma once

#include <cstdint>

#include "hal/history.h"
#include "hal/imu.h"

namespace touchline {

/// Torso attitude at one time.
struct TorsoAttitude {
  float yaw = 0.0F;  // continuous, radians
  bool has_tilt = false;
  float roll = 0.0F;
  float pitch = 0.0F;
};
inline TorsoAttitude interpolate(const TorsoAttitude& from, const TorsoAttitude& to, float share) {
  const auto angle = [&](float a, float b) { return wrap_angle(a + angle_difference(b, a) * share); };
  return {interpolate(from.yaw, to.yaw, share), from.has_tilt && to.has_tilt, angle(from.roll, to.roll),
          angle(from.pitch, to.pitch)};
}

class YawHistory {
 public:
  /// `max_rate`: no torso turns faster, rad/s; `slack`: noise of the device, rad.
  explicit YawHistory(float max_rate = radians(720), float slack = radians(10)) : max_rate_(max_rate), slack_(slack) {}

  /// ok: taken. invalid_argument: not finite. corrupt: the yaw jumped: not used; if the next sample agrees with it, the
  /// device has a new zero and the curve goes on without the jump. stale: not newer than the newest.
  Status push(const ImuSample& sample);
  /// The device came back after a gap: its zero may be another. The curve goes on at the newest yaw plus `turned`, the
  /// turn in the gap as the odometry knows it.
  void reattach(float turned);

  /// Statuses of History::at().
  [[nodiscard]] Result<TorsoAttitude> at(MonotonicNs time) const { return curve_.at(time, max_ahead); }
  [[nodiscard]] bool empty() const { return curve_.empty(); }
  [[nodiscard]] MonotonicNs newest_time() const { return curve_.newest_time(); }
  [[nodiscard]] const TorsoAttitude& newest() const { return curve_.newest(); }
  [[nodiscard]] std::uint32_t jumps() const { return jumps_; }
  /// What the curve has more than the device reads: the zeros that the device has changed, summed.
  [[nodiscard]] float offset() const { return offset_; }

 private:
  /// A quarter of a second at 1 kHz, 2.5 s at 100 Hz.
  static constexpr std::size_t capacity = 256;
  static constexpr MonotonicNs max_ahead = 50 * one_millisecond;

  [[nodiscard]] bool plausible(const ImuSample& from, const ImuSample& to) const;

  float max_rate_;
  float slack_;
  History<TorsoAttitude, capacity> curve_;
  float offset_ = 0.0F;  // curve minus device
  bool has_last_ = false;
  ImuSample last_;
  bool has_odd_ = false;
  ImuSample odd_;
  bool reattach_ = false;
  float turned_ = 0.0F;
  std::uint32_t jumps_ = 0;
};

}  // namespace touchline
