// SPDX-License-Identifier: Apache-2.0
#include "loc/localizer.h"

#include "loc/motion_model.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

bool in_range(float x, float low, float high) { return math::is_finite(x) && x >= low && x <= high; }

/// The first key that is out of range, or null.
const char* first_bad_key(const LocalizerConfig& c) {
  if (c.particles < 10 || c.particles > max_particles) return "particles";
  if (!in_range(c.motion.xy_per_metre, 0.0F, 10.0F)) return "motion.xy_per_metre";
  if (!in_range(c.motion.xy_per_radian, 0.0F, 10.0F)) return "motion.xy_per_radian";
  if (!in_range(c.motion.theta_per_metre, 0.0F, 10.0F)) return "motion.theta_per_metre";
  if (!in_range(c.motion.theta_per_radian, 0.0F, 10.0F)) return "motion.theta_per_radian";
  if (!in_range(c.motion.xy_floor, 0.0F, 1.0F)) return "motion.xy_floor";
  if (!in_range(c.motion.theta_floor, 0.0F, 1.0F)) return "motion.theta_floor";
  if (!in_range(c.features.gamma, 1.0F, 1e4F)) return "features.gamma";
  if (!in_range(c.features.threshold, 0.0F, 1.0F)) return "features.threshold";
  if (!in_range(c.augmented.random_share, 0.0F, 0.5F)) return "augmented.random_share";
  if (!in_range(c.yaw_sigma, 1e-3F, math::pi)) return "yaw_sigma";
  if (!in_range(c.yaw_drift_rate, 0.0F, 1.0F)) return "yaw_drift_rate";
  if (!in_range(c.tilt_sigma, 1e-4F, 0.2F)) return "tilt_sigma";
  if (!in_range(c.line_sigma_floor, 1e-3F, 0.5F)) return "line_sigma_floor";
  if (!in_range(c.landmark_variance_floor, 1e-4F, 10.0F)) return "landmark_variance_floor";
  if (!in_range(c.confident, 0.0F, 1.0F)) return "confident";
  return nullptr;
}

PoseCovariance grown(PoseCovariance c, const StepSigma& s, float theta) {
  const float co = math::cos(theta);
  const float si = math::sin(theta);
  const float vx = s.x * s.x;
  const float vy = s.y * s.y;
  c.xx += co * co * vx + si * si * vy;
  c.yy += si * si * vx + co * co * vy;
  c.xy += co * si * (vx - vy);
  c.tt += s.theta * s.theta;
  return c;
}

}  // namespace

Status Localizer::configure(const LocalizerConfig& config, const Field& field, const char** what) {
  const char* bad = first_bad_key(config);
  if (bad == nullptr && field.lines().empty()) bad = "field";
  if (bad != nullptr) {
    if (what != nullptr) *what = bad;
    return Status::invalid_argument;
  }
  const bool running = configured_ && frames_ >= 0;
  const bool same_cloud = config.particles == config_.particles && config.model == config_.model;
  config_ = config;
  field_ = field;
  map_.build(field_);
  configured_ = true;
  if (!running) {
    frames_ = -1;  // a reset has to follow
  } else if (!same_cloud) {
    draw_around_last();
  }
  return Status::ok;
}

void Localizer::reset(const Prior& prior, std::uint64_t seed) {
  rng_ = Rng(seed);
  features_.clear();
  augmented_.reset();
  yaw_.reset();
  last_ = {};
  frames_ = 0;
  cloud_ = 0;
  belief_ = 0.0F;
  steady_frames_ = 0;
  draw_from_prior(prior);
}

/// Another number of particles, or another model of them, while the robot plays.
void Localizer::draw_around_last() {
  Prior prior;
  if (last_.valid) {
    const PoseCovariance& p = last_.covariance;
    prior = {PriorKind::pose, last_.pose, math::sqrt(math::max(p.xx, p.yy)), math::sqrt(p.tt)};
  }
  cloud_ = 0;
  draw_from_prior(prior);
}

void Localizer::draw_from_prior(const Prior& prior) {
  const float half_length = field_.half_carpet_length();
  const float half_width = field_.half_carpet_width();
  const ParticleView p = particles();
  for (int i = 0; i < p.count; ++i) {
    Pose2 pose{rng_.uniform(-half_length, half_length), rng_.uniform(-half_width, half_width),
               rng_.uniform(-math::pi, math::pi)};
    if (prior.kind == PriorKind::own_half) pose.x = -math::abs(pose.x);
    if (prior.kind == PriorKind::touch_line) {
      const float side = i % 2 == 0 ? 1.0F : -1.0F;
      pose = {-math::abs(pose.x), side * 0.5F * field_.dimensions().width + 0.15F * rng_.gaussian(),
              wrap_angle(-side * math::half_pi + prior.sigma_theta * rng_.gaussian())};
    }
    if (prior.kind == PriorKind::pose) {
      pose = {prior.pose.x + prior.sigma_xy * rng_.gaussian(), prior.pose.y + prior.sigma_xy * rng_.gaussian(),
              wrap_angle(prior.pose.theta + prior.sigma_theta * rng_.gaussian())};
    }
    p.set_pose(i, pose);
    p.log_weight[i] = 0.0F;
  }
}

Pose2 Localizer::random_pose(const YawEvidence& yaw) {
  const float theta = yaw.known ? yaw.theta + yaw.sigma * rng_.gaussian() : rng_.uniform(-math::pi, math::pi);
  return {rng_.uniform(-field_.half_carpet_length(), field_.half_carpet_length()),
          rng_.uniform(-field_.half_carpet_width(), field_.half_carpet_width()), wrap_angle(theta)};
}

void Localizer::predict(const LocalizerInput& input) {
  MotionNoise noise = config_.motion;
  noise.xy_floor += input.unknown_xy;
  noise.theta_floor += input.unknown_theta;
  move_particles(particles(), input.odometry, noise, rng_);
  if (!last_.valid) return;
  last_.covariance = grown(last_.covariance, step_sigma(input.odometry, noise), last_.pose.theta);
  last_.pose = compose(last_.pose, input.odometry);
  const float seconds = static_cast<float>(input.time_s - last_time_s_);
  if (seconds > 0.0F && seconds < 10.0F) yaw_.predict(seconds, config_.yaw_drift_rate);
}

Status Localizer::update(const LocalizerInput& input, const VisionResult& vision, PoseEstimate& estimate,
                         StageObserver* observer) {
  if (!configured_ || frames_ < 0) return Status::not_ready;
  if (!math::is_finite(input.odometry.x) || !math::is_finite(input.odometry.y) ||
      !math::is_finite(input.odometry.theta) || !math::is_finite(input.unknown_xy) ||
      !math::is_finite(input.unknown_theta) || (input.has_yaw && !math::is_finite(input.yaw)) ||
      input.time_s - input.time_s != 0.0) {
    return Status::invalid_argument;
  }
  const StageScope scope(observer, Stage::localize);
  if (input.moved_by_hand) {
    draw_from_prior(Prior{});
    features_.clear();
    last_ = {};
  } else {
    predict(input);
  }
  const YawEvidence yaw = input.has_yaw ? yaw_.evidence(input.yaw, config_.yaw_sigma) : YawEvidence{};
  features_.update(input.odometry, vision, config_.landmarks, field_,
                   certainty(last_) > config_.confident ? &last_.pose : nullptr, config_.features);
  make_observation(vision, config_, observation_);
  if (config_.model == LocModel::full) {
    update_full(vision, yaw, estimate);
  } else {
    update_paper(vision, yaw, estimate);
  }
  if (input.has_yaw && estimate.valid && estimate.confidence > config_.confident) {
    yaw_.correct(input.yaw, estimate.pose.theta, estimate.covariance.tt, config_.yaw_sigma);
  }
  estimate.yaw_drift = yaw_.drift();
  last_ = estimate;
  last_time_s_ = input.time_s;
  ++frames_;
  return Status::ok;
}

void Localizer::settle(PoseEstimate& estimate, float spread_m, float spread_rad) {
  const bool steady = certainty(estimate) > config_.confident && last_.valid &&
                      math::hypot(estimate.pose.x - last_.pose.x, estimate.pose.y - last_.pose.y) < spread_m &&
                      math::abs(angle_difference(estimate.pose.theta, last_.pose.theta)) < spread_rad;
  steady_frames_ = steady ? steady_frames_ + 1 : 0;
  estimate.settled = steady_frames_ >= 2;
}

}  // namespace touchline
