// SPDX-License-Identifier: Apache-2.0
#include "hal/yaw_history.h"

#include "platform/core/elementary.h"

namespace touchline {
bool YawHistory::plausible(const ImuSample& from, const ImuSample& to) const {
  const float seconds = static_cast<float>(to.time - from.time) * 1e-9F;
  return math::abs(to.yaw - from.yaw) <= max_rate_ * seconds + slack_;
}

Status YawHistory::push(const ImuSample& sample) {
  if (!math::is_finite(sample.yaw)) return Status::invalid_argument;
  if (sample.has_tilt && !(math::is_finite(sample.roll) && math::is_finite(sample.pitch)))
    return Status::invalid_argument;
  if (has_last_ && sample.time <= last_.time) return Status::stale;
  if (has_last_ && reattach_) {
    offset_ = curve_.newest().yaw + turned_ - sample.yaw;
  } else if (has_last_ && !plausible(last_, sample)) {
    const bool confirmed = has_odd_ && plausible(odd_, sample);
    if (!confirmed) {
      ++jumps_;
      has_odd_ = true;
      odd_ = sample;
      return Status::corrupt;
    }
    offset_ = curve_.newest().yaw - sample.yaw;
  }
  reattach_ = false;
  has_odd_ = false;
  has_last_ = true;
  last_ = sample;
  return curve_.push(sample.time, {sample.yaw + offset_, sample.has_tilt, sample.roll, sample.pitch});
}

void YawHistory::reattach(float turned) {
  reattach_ = true;
  turned_ = turned;
}

}  // namespace touchline
