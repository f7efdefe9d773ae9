// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/sensors.h"

#include "platform/host/sim/vec.h"

namespace touchline::sim {

Pose2 SimGait::step(const WorldState& state, float dt) {
  const bool down = state.activity == Activity::fallen || state.activity == Activity::lifted;
  const float draw = rng_.uniform();
  const float gx = rng_.gaussian();
  const float gy = rng_.gaussian();
  const float gt = rng_.gaussian();
  if (down || state.kidnapped) return {};
  // A foot slips: the robot did less than the gait commanded, so the gait believes in more.
  if (errors_.seconds_between_slips > 0.0F && draw < dt / errors_.seconds_between_slips) slip_left_ = 0.5F;
  const float grip = slip_left_ > 0.0F ? 1.0F / (1.0F - errors_.slip_share) : 1.0F;
  slip_left_ = math::max(slip_left_ - dt, 0.0F);
  const bool walks = length(state.step.x, state.step.y) > 0.02F * dt || math::abs(state.step.theta) > 0.05F * dt;
  const float moving = walks ? 1.0F : 0.0F;
  const float spread = moving * square_root(dt);
  Pose2 believed;
  believed.x = state.step.x * errors_.scale_x * grip + gx * errors_.noise_xy * spread;
  believed.y = state.step.y * errors_.scale_y * grip + gy * errors_.noise_xy * spread;
  believed.theta =
      state.step.theta * errors_.scale_theta + (gt * errors_.noise_theta * spread) - moving * errors_.drift * dt;
  return believed;
}

SimImu::SimImu(const ImuErrors& errors, std::uint64_t seed) : errors_(errors), rng_(seed, 9) {
  pitch_error_ = rng_.gaussian();
  roll_error_ = rng_.gaussian();
}

void SimImu::step(const WorldState& state, float dt) {
  heading_ = started_ ? heading_ + angle_difference(state.pose.theta, heading_) : state.pose.theta;
  if (started_) bias_ += errors_.drift * dt + errors_.wander * square_root(dt) * rng_.gaussian();
  started_ = true;
  yaw_ = heading_ + errors_.goal_yaw + bias_ + errors_.noise * rng_.gaussian();
  // A slowly varying part (Gauss-Markov) and a new part each time; together one sigma of `tilt`.
  const float keep = math::exp(-dt / errors_.tilt_time);
  const float fresh = square_root(1.0F - keep * keep);
  pitch_error_ = keep * pitch_error_ + fresh * rng_.gaussian();
  roll_error_ = keep * roll_error_ + fresh * rng_.gaussian();
  const float slow = errors_.tilt * square_root(1.0F - errors_.tilt_white_share);
  const float white = errors_.tilt * square_root(errors_.tilt_white_share);
  camera_ = state.camera;
  camera_.pitch += slow * pitch_error_ + white * rng_.gaussian();
  camera_.roll += slow * roll_error_ + white * rng_.gaussian();
}

}  // namespace touchline::sim
