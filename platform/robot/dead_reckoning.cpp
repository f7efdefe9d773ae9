// SPDX-License-Identifier: Apache-2.0
#include "platform/robot/dead_reckoning.h"

#include "loc/motion_model.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float max_sigma_xy = 1.0F;
constexpr float max_sigma_theta = 0.6F;
constexpr float confidence_rate = 0.231F;  // 1/s: ln 2 / 3 s

/// First order: the old error of theta swings the step, then the step's own noise is added (Probabilistic
/// Robotics, 7.4).
PoseCovariance grown(const PoseCovariance& p, const Pose2& pose, const Motion& motion, const StepSigma& sigma) {
  const float c = math::cos(pose.theta), s = math::sin(pose.theta);
  const Pose2& d = motion.step;
  const float gx = -d.x * s - d.y * c;  // change of x and y with theta
  const float gy = d.x * c - d.y * s;
  const float extra = math::square(motion.unknown_xy);
  const float along = math::square(sigma.x) + extra, across = math::square(sigma.y) + extra;
  PoseCovariance q;
  q.xx = p.xx + 2.0F * gx * p.xt + gx * gx * p.tt + c * c * along + s * s * across;
  q.yy = p.yy + 2.0F * gy * p.yt + gy * gy * p.tt + s * s * along + c * c * across;
  q.xy = p.xy + gx * p.yt + gy * p.xt + gx * gy * p.tt + c * s * (along - across);
  q.xt = p.xt + gx * p.tt;
  q.yt = p.yt + gy * p.tt;
  q.tt = p.tt + math::square(sigma.theta) + math::square(motion.unknown_theta);
  return q;
}

}  // namespace

void reckon(PoseEstimate& estimate, const Motion& motion, const MotionNoise& noise, float seconds) {
  if (!estimate.valid) return;
  estimate.covariance = grown(estimate.covariance, estimate.pose, motion, step_sigma(motion.step, noise));
  estimate.pose = compose(estimate.pose, motion.step);
  if (estimate.has_mirror) estimate.mirror = compose(estimate.mirror, motion.step);
  const float fade = math::exp(-confidence_rate * math::clamp(seconds, 0.0F, 100.0F));
  estimate.confidence *= fade;
  estimate.mirror_confidence *= fade;
  estimate.settled = false;
  const PoseCovariance& p = estimate.covariance;
  const bool lost = p.xx + p.yy > math::square(max_sigma_xy) || p.tt > math::square(max_sigma_theta);
  if (lost) estimate = {};
}

}  // namespace touchline
