// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/world.h"

#include "platform/host/sim/vec.h"

namespace touchline::sim {
namespace {

constexpr float smoothing = 0.35F;     // seconds in which a gait follows a new command
constexpr float arrived = 0.25F;       // metres
constexpr float keep_away = 0.45F;     // metres between the robot and another
constexpr float bow_when_down = 1.2F;  // radians that the camera tips over in a fall

}  // namespace

SimWorld::SimWorld(const WalkOptions& options) : options_(options), rng_(options.seed, 7) {
  const FieldPoint at = random_point(0.4F);
  state_.pose = {at.x, at.y, rng_.uniform(-math::pi, math::pi)};
  state_.camera = options.camera;
  state_.phase = rng_.uniform(0.0F, math::two_pi);
  goal_ = random_point(0.3F);
  ball_ = random_point(0.2F);
  for (int i = 0; i < options.robots; ++i) {
    const FieldPoint p = random_point(0.3F);
    robots_.push_back({p.x, p.y, rng_.uniform(-math::pi, math::pi)});
    robot_goals_.push_back(random_point(0.3F));
  }
}

FieldPoint SimWorld::random_point(float inset) {
  const float x = options_.field.length * 0.5F - inset;
  const float y = options_.field.width * 0.5F - inset;
  const float px = rng_.uniform(-x, x);
  return {px, rng_.uniform(-y, y)};
}

void SimWorld::kidnap(const Pose2& to) {
  move_pending_ = true;
  move_to_ = to;
}

void SimWorld::kidnap_anywhere() {
  const FieldPoint p = random_point(0.3F);
  kidnap({p.x, p.y, rng_.uniform(-math::pi, math::pi)});
}

void SimWorld::fall(float seconds) {
  state_.activity = Activity::fallen;
  remaining_ = seconds;
  down_roll_ = rng_.uniform(-0.6F, 0.6F);
}

void SimWorld::lift(float seconds, const Pose2& to) {
  state_.activity = Activity::lifted;
  remaining_ = seconds;
  put_down_ = to;
}

void SimWorld::turn_on_centre() {
  goal_ = {0.0F, 0.0F};
  centre_next_ = true;
}

void SimWorld::choose_next() {
  if (centre_next_ && state_.activity == Activity::walking) {
    centre_next_ = false;
    state_.activity = Activity::turning;
    remaining_ = math::two_pi;
    return;
  }
  const float pick = rng_.uniform();
  if (state_.activity == Activity::walking && pick < 0.25F) {
    state_.activity = Activity::halted;
    remaining_ = rng_.uniform(0.5F, 2.0F);
    return;
  }
  state_.activity = Activity::walking;
  goal_ = random_point(0.3F);
  if (pick > 0.85F) turn_on_centre();
}

void SimWorld::steer(float dt) {
  want_ahead_ = 0.0F;
  want_turn_ = 0.0F;
  if (state_.activity == Activity::halted || state_.activity == Activity::turning) {
    if (state_.activity == Activity::turning) want_turn_ = options_.turn_rate;
    remaining_ -= state_.activity == Activity::turning ? math::abs(turn_) * dt : dt;
    if (remaining_ <= 0.0F) choose_next();
    return;
  }
  const GroundPoint to = to_ground(state_.pose, goal_);
  if (length(to.x, to.y) < arrived) {
    choose_next();
    return;
  }
  const float bearing = math::atan2(to.y, to.x);
  want_turn_ = math::clamp(1.2F * bearing, -options_.turn_rate, options_.turn_rate);
  want_ahead_ = options_.speed * math::max(math::cos(bearing), 0.0F);
  for (const Pose2& other : robots_) {
    const GroundPoint near = to_ground(state_.pose, {other.x, other.y});
    if (near.x > 0.0F && near.x < keep_away && math::abs(near.y) < 0.35F) {
      want_ahead_ = 0.0F;  // waits: the other gives way
    }
  }
}

void SimWorld::walk(float dt) {
  steer(dt);
  const float follow = math::min(dt / smoothing, 1.0F);
  ahead_ += (want_ahead_ - ahead_) * follow;
  turn_ += (want_turn_ - turn_) * follow;
  sideways_ += (rng_.gaussian() * 0.02F - sideways_) * follow;
  const float half = turn_ * dt * 0.5F;  // the mean heading of the step
  const float forward = ahead_ * dt;
  const float left = sideways_ * dt;
  state_.step = {forward * math::cos(half) - left * math::sin(half), forward * math::sin(half) + left * math::cos(half),
                 turn_ * dt};
  state_.pose = compose(state_.pose, state_.step);
  const float moving = math::min((math::abs(ahead_) + 0.2F * math::abs(turn_)) / 0.10F, 1.0F);
  stride_ += (moving - stride_) * follow;
  if (options_.seconds_between_falls > 0.0F && rng_.uniform() < dt / options_.seconds_between_falls) {
    fall(rng_.uniform(2.0F, 4.0F));
  }
}

void SimWorld::lie(float dt) {
  state_.step = {};
  ahead_ = sideways_ = turn_ = 0.0F;
  remaining_ -= dt;
  if (remaining_ > 0.0F) return;
  if (state_.activity == Activity::lifted) state_.pose = put_down_;
  stride_ = 0.0F;
  state_.activity = Activity::walking;
  goal_ = random_point(0.3F);
}

void SimWorld::sway(float dt) {
  state_.phase += dt * math::two_pi / options_.step_period;
  if (state_.phase > math::two_pi) state_.phase -= math::two_pi;
  state_.camera = options_.camera;
  if (state_.activity == Activity::fallen) {
    state_.camera.height = 0.18F;
    state_.camera.pitch += bow_when_down * (down_roll_ > 0.0F ? 1.0F : -1.0F);
    state_.camera.roll += down_roll_;
    return;
  }
  if (state_.activity == Activity::lifted) {
    state_.camera.height += 0.4F;
    state_.camera.pitch += 0.5F * math::sin(state_.phase * 0.5F);
    state_.camera.roll += 0.7F * math::sin(state_.phase * 0.5F + 1.0F);
    return;
  }
  state_.camera.height += options_.sway_height * stride_ * math::sin(state_.phase - 0.5F);
  state_.camera.pitch += options_.sway_pitch * stride_ * math::sin(state_.phase);
  state_.camera.roll += options_.sway_roll * stride_ * math::sin(state_.phase - math::half_pi);
}

void SimWorld::move_others(float dt) {
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    const GroundPoint to = to_ground(robots_[i], robot_goals_[i]);
    if (length(to.x, to.y) < arrived) robot_goals_[i] = random_point(0.3F);
    const float bearing = math::atan2(to.y, to.x);
    const float turn = math::clamp(bearing, -0.6F, 0.6F) * dt;
    const float ahead = 0.15F * math::max(math::cos(bearing), 0.0F) * dt;
    const Pose2 next = compose(robots_[i], {ahead, 0.0F, turn});
    // Gives way: steps straight away from the robot while that is near.
    const float dx = next.x - state_.pose.x;
    const float dy = next.y - state_.pose.y;
    const float away = math::max(length(dx, dy), 1e-3F);
    robots_[i] = next;
    if (away >= keep_away) continue;
    const float escape = math::min(0.25F * dt, keep_away - away) / away;
    robots_[i].x += dx * escape;
    robots_[i].y += dy * escape;
    robot_goals_[i] = random_point(0.3F);
  }
  const float near = length(ball_.x - state_.pose.x, ball_.y - state_.pose.y);
  if (near < 0.15F) ball_ = random_point(0.2F);  // kicked away
}

void SimWorld::step(float dt) {
  state_.time_s += static_cast<double>(dt);
  state_.kidnapped = false;
  if (state_.activity == Activity::fallen || state_.activity == Activity::lifted) {
    lie(dt);
  } else {
    walk(dt);
  }
  if (move_pending_) {
    state_.pose = move_to_;
    state_.step = {};
    state_.kidnapped = true;
    move_pending_ = false;
  }
  move_others(dt);
  sway(dt);
}

}  // namespace touchline::sim
