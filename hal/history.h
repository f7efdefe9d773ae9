// SPDX-License-Identifier: Apache-2.0
// What a value was at a time in the recent past: a late frame corrects where the robot was then, not where it is now.
#pragma once

#include <cstddef>

#include "platform/core/geometry.h"
#include "platform/core/result.h"
#include "platform/core/ring_buffer.h"
#include "platform/core/time.h"

namespace touchline {

inline float interpolate(float from, float to, float share) { return from + (to - from) * share; }
/// Along the straight line, and the short way round in theta. `share` may lie a little outside [0, 1].
inline Pose2 interpolate(const Pose2& from, const Pose2& to, float share) {
  const float turn = angle_difference(to.theta, from.theta);
  return {interpolate(from.x, to.x, share), interpolate(from.y, to.y, share), wrap_angle(from.theta + turn * share)};
}

/// N samples: N times the sensor's period is how late a frame may be.
template <typename T, std::size_t N>
class History {
 public:
  /// stale: not newer than the newest; nothing has changed.
  Status push(MonotonicNs time, const T& value) {
    if (!samples_.empty() && time <= samples_.newest().time) return Status::stale;
    samples_.push({time, value});
    return Status::ok;
  }
  void clear() { samples_.clear(); }
  [[nodiscard]] bool empty() const { return samples_.empty(); }
  /// Only while not empty().
  [[nodiscard]] MonotonicNs newest_time() const { return samples_.newest().time; }
  [[nodiscard]] const T& newest() const { return samples_.newest().value; }

  /// The value at `time`: between two samples on the straight line; after the newest on the last line for at most
  /// `ahead`. not_ready: empty. stale: older than all samples, or later than the newest by more than `ahead`.
  [[nodiscard]] Result<T> at(MonotonicNs time, MonotonicNs ahead) const {
    if (samples_.empty()) return Status::not_ready;
    if (time < samples_.oldest().time || time > newest_time() + ahead) return Status::stale;
    if (samples_.size() == 1) return newest();
    std::size_t after = samples_.size() - 1;  // bounded by N; nearly always one of the last few
    while (after > 1 && samples_[after - 1].time > time) --after;
    const Sample& a = samples_[after - 1];
    const Sample& b = samples_[after];
    const float share = static_cast<float>(time - a.time) / static_cast<float>(b.time - a.time);
    // A line through two samples that lie close together would shoot far past them.
    return interpolate(a.value, b.value, share > 2.0F ? 2.0F : share);
  }

 private:
  struct Sample {
    MonotonicNs time = 0;
    T value{};
  };
  RingBuffer<Sample, N> samples_;
};

}  // namespace touchline
