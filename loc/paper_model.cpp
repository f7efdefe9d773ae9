// SPDX-License-Identifier: Apache-2.0
// The paper's localization (section VI): eq. (5) on the tracked features, the IMU's yaw against the mirrored pose,
// low-variance resampling, random particles by augmented MCL.
#include "loc/localizer.h"
#include "loc/paper_likelihood.h"
#include "loc/resampling.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float cluster_radius_m = 0.5F;
constexpr float cluster_angle = radians(30.0F);

constexpr float random_share =
    0.1F;  // 200 particles are too thin for the field: only a steady rain finds what the first cloud missed
constexpr float roughening = 0.1F;  // between the 0.2 of its authors and what a cloud of 200 needs to close in

float average_weight(ParticleView p) {
  float sum = 0.0F;
  for (int i = 0; i < p.count; ++i) sum += math::exp(p.log_weight[i]);
  return p.count > 0 ? sum / static_cast<float>(p.count) : 0.0F;
}

}  // namespace

void Localizer::update_paper(const VisionResult& /*vision*/, const YawEvidence& yaw, PoseEstimate& estimate) {
  const ParticleView p = particles();
  if (frames_ == 0 && yaw.known) {
    for (int i = 0; i < p.count; ++i) p.theta[i] = wrap_angle(yaw.theta + yaw.sigma * rng_.gaussian());
  }
  for (int i = 0; i < p.count; ++i) p.log_weight[i] += yaw_log_likelihood(yaw, p.theta[i]);
  add_paper_likelihood(field_, features_, config_.features, config_.landmark_variance_floor, cloud_, false, p);
  augmented_.update(average_weight(p), config_.augmented);

  find_clusters(p, cluster_radius_m, cluster_angle, resampling_.weights.data(), clusters_, cluster_index_);
  estimate = {};
  bool anything_seen = false;
  for (int t = 0; t < feature_types; ++t)
    anything_seen = anything_seen || !features_.list(static_cast<FeatureType>(t)).empty();
  if (!clusters_.empty() && (anything_seen || last_.valid)) {
    const Cluster& best = clusters_[0];
    estimate.valid = true;
    estimate.pose = best.mean;
    estimate.covariance = best.covariance;
    estimate.confidence = best.mass;
    for (const Cluster& c : clusters_) {
      const Pose2 m = mirrored(best.mean);
      if (math::hypot(c.mean.x - m.x, c.mean.y - m.y) < cluster_radius_m && !estimate.has_mirror) {
        estimate.has_mirror = true;
        estimate.mirror = c.mean;
        estimate.mirror_confidence = c.mass;
      }
    }
  }
  settle(estimate, 0.05F, radians(3.0F));
  if (effective_count(p) > 0.5F * static_cast<float>(p.count)) return;  // weights add up until they tell enough
  const float share = math::max(random_share, augmented_.random_share(config_.augmented));
  resample(yaw, share);
  ParticleView kept = p;
  cloud_ = p.count - part_of(p.count, share);
  kept.count = cloud_;
  roughen(kept, roughening, rng_);
}

}  // namespace touchline
