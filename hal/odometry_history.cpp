// SPDX-License-Identifier: Apache-2.0
#include "hal/odometry_history.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

Pose2 step_between(const GaitSample& from, const GaitSample& to) {
  return compose(inverse(from.odometry), to.odometry);
}

}  // namespace

bool OdometryHistory::plausible(const GaitSample& from, const GaitSample& to) const {
  const float seconds = static_cast<float>(to.time - from.time) * 1e-9F;
  const Pose2 step = step_between(from, to);
  return math::hypot(step.x, step.y) <= limits_.speed * seconds + limits_.slack &&
         math::abs(step.theta) <= limits_.turn_rate * seconds + limits_.turn_slack;
}

Status OdometryHistory::push(const GaitSample& sample) {
  const Pose2& odometry = sample.odometry;
  if (!math::is_finite(odometry.x) || !math::is_finite(odometry.y) || !math::is_finite(odometry.theta))
    return Status::invalid_argument;
  if (has_last_ && sample.time <= last_.time) return Status::stale;
  const Pose2 here = path_.empty() ? Pose2{} : path_.newest();
  const bool same_boot = has_last_ && sample.boot_id == last_.boot_id;
  Pose2 step;  // after a restart, and at the start: none that is known
  if (same_boot && plausible(last_, sample)) {
    step = step_between(last_, sample);
  } else if (same_boot) {
    const bool confirmed = has_odd_ && odd_.boot_id == sample.boot_id && plausible(odd_, sample);
    if (!confirmed) {
      ++jumps_;
      has_odd_ = true;
      odd_ = sample;
      return Status::corrupt;
    }
    step = step_between(odd_, sample);
  }
  has_last_ = true;
  last_ = sample;
  has_odd_ = false;
  return path_.push(sample.time, compose(here, step));
}

Result<Pose2> OdometryHistory::step(MonotonicNs from, MonotonicNs to) const {
  const Result<Pose2> a = at(from);
  const Result<Pose2> b = at(to);
  if (!a.ok()) return a.status();
  if (!b.ok()) return b.status();
  return compose(inverse(a.value()), b.value());
}

}  // namespace touchline
