// SPDX-License-Identifier: Apache-2.0
#include "loc/localizer.h"

#include "loc/motion_model.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

bool in_range(float x, float low, float high) { return math::is_finite(x) && x >= low && x <= high; }

const char* first_bad_key(const MotionNoise& m) {
  if (!in_range(m.xy_per_metre, 0.0F, 10.0F)) return "motion.xy_per_metre";
  if (!in_range(m.xy_per_radian, 0.0F, 10.0F)) return "motion.xy_per_radian";
  if (!in_range(m.theta_per_metre, 0.0F, 10.0F)) return "motion.theta_per_metre";
  if (!in_range(m.theta_per_radian, 0.0F, 10.0F)) return "motion.theta_per_radian";
  if (!in_range(m.xy_floor, 0.0F, 1.0F)) return "motion.xy_floor";
  if (!in_range(m.theta_floor, 0.0F, 1.0F)) return "motion.theta_floor";
  return nullptr;
}

const char* first_bad_key(const FeatureManagerConfig& f) {
  if (!in_range(f.gamma, 1.0F, 1e4F)) return "features.gamma";
  if (!in_range(f.threshold, 0.0F, 1.0F)) return "features.threshold";
  if (!in_range(f.gate_m, 0.0F, max_field_length)) return "features.gate_m";
  if (!in_range(f.validation_gate_m, 0.0F, max_field_length)) return "features.validation_gate_m";
  if (!in_range(f.base_l, 0.0F, 1.0F)) return "features.base_l";
  if (!in_range(f.base_t, 0.0F, 1.0F)) return "features.base_t";
  if (!in_range(f.base_x, 0.0F, 1.0F)) return "features.base_x";
  if (!in_range(f.base_post, 0.0F, 1.0F)) return "features.base_post";
  if (!in_range(f.axis_half_angle, radians(1.0F), math::pi)) return "features.axis_half_angle";
  return nullptr;
}

/// The first key that is out of range, or null.
const char* first_bad_key(const LocalizerConfig& c) {
  if (c.model > LocModel::full) return "model";
  if (c.landmarks > Landmarks::both) return "landmarks";
  if (c.particles < 10 || c.particles > max_particles) return "particles";
  if (const char* bad = first_bad_key(c.motion); bad != nullptr) return bad;
  if (const char* bad = first_bad_key(c.features); bad != nullptr) return bad;
  if (!in_range(c.augmented.alpha_slow, 0.0F, 1.0F)) return "augmented.alpha_slow";
  if (!in_range(c.augmented.alpha_fast, 0.0F, 1.0F)) return "augmented.alpha_fast";
  if (!in_range(c.augmented.random_share, 0.0F, 0.5F)) return "augmented.random_share";
  if (!in_range(c.yaw_sigma, 1e-3F, math::pi)) return "yaw_sigma";
  if (!in_range(c.yaw_drift_rate, 0.0F, 1.0F)) return "yaw_drift_rate";
  if (!in_range(c.tilt_sigma, 1e-4F, 0.2F)) return "tilt_sigma";
  if (!in_range(c.line_sigma_floor, 1e-3F, 0.5F)) return "line_sigma_floor";
  if (!in_range(c.landmark_variance_floor, 1e-4F, 10.0F)) return "landmark_variance_floor";
  if (!in_range(c.confident, 0.0F, 1.0F)) return "confident";
  const LocKernels& k = c.kernels;
  if (k.line_costs == nullptr || k.landmark_costs == nullptr || k.linearise == nullptr || k.sin_cos == nullptr ||
      k.normals == nullptr)
    return "kernels";
  return nullptr;
}

bool is_valid(const Prior& p) {
  return p.kind <= PriorKind::pose && in_range(p.pose.x, -max_step_m, max_step_m) &&
         in_range(p.pose.y, -max_step_m, max_step_m) && in_range(p.pose.theta, -max_angle, max_angle) &&
         in_range(p.sigma_xy, 0.0F, max_step_m) && in_range(p.sigma_theta, 0.0F, max_step_rad);
}

bool is_valid(const LocalizerInput& i) {
  return in_range(i.odometry.x, -max_step_m, max_step_m) && in_range(i.odometry.y, -max_step_m, max_step_m) &&
         in_range(i.odometry.theta, -max_step_rad, max_step_rad) && in_range(i.unknown_xy, 0.0F, max_step_m) &&
         in_range(i.unknown_theta, 0.0F, max_step_rad) && (!i.has_yaw || in_range(i.yaw, -max_angle, max_angle)) &&
         i.time_s - i.time_s == 0.0;
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

Status Localizer::reset(const Prior& prior, std::uint64_t seed) {
  if (!configured_) return Status::not_ready;
  if (!is_valid(prior)) return Status::invalid_argument;
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
  return Status::ok;
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

void Localizer::forget_place() {
  draw_from_prior(Prior{});
  features_.clear();
  last_ = {};
}

/// Robots are carried about beside the carpet, but not far from it: there the odometry has lost its way.
bool Localizer::is_near_field(const PoseEstimate& estimate) const {
  const float x = math::abs(estimate.pose.x);
  const float y = math::abs(estimate.pose.y);
  return x <= field_.half_carpet_length() + max_beside_m && y <= field_.half_carpet_width() + max_beside_m &&
         math::is_finite(estimate.pose.theta) && math::is_finite(estimate.confidence);
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
  move_particles(particles(), input.odometry, noise, config_.kernels, rng_);
  if (!last_.valid) return;
  last_.covariance = grown(last_.covariance, step_sigma(input.odometry, noise), last_.pose.theta);
  last_.pose = compose(last_.pose, input.odometry);
  const float seconds = static_cast<float>(input.time_s - last_time_s_);
  if (seconds > 0.0F && seconds < 10.0F) yaw_.predict(seconds, config_.yaw_drift_rate);
}

Status Localizer::update(const LocalizerInput& input, const VisionResult& vision, PoseEstimate& estimate,
                         StageObserver* observer) {
  if (!configured_ || frames_ < 0) return Status::not_ready;
  if (!is_valid(input)) return Status::invalid_argument;
  const StageScope scope(observer, Stage::localize);
  if (input.moved_by_hand) {
    forget_place();
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
  if (estimate.valid && !is_near_field(estimate)) {
    forget_place();
    estimate = {};
    belief_ = 0.0F;
    steady_frames_ = 0;
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
