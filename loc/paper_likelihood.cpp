// SPDX-License-Identifier: Apache-2.0
#include "loc/paper_likelihood.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

struct TypedLandmark {
  FieldPoint at;
  float inverse_two_variance = 0.0F;
};
using TypedLandmarks = StaticVector<TypedLandmark, max_field_landmarks>;

/// Variance over the particles of their distance to `l`, in metres squared.
float distance_variance(ParticleView particles, const FieldPoint& l) {
  float sum = 0.0F;
  float squares = 0.0F;
  for (int i = 0; i < particles.count; ++i) {
    const float d = math::hypot(particles.x[i] - l.x, particles.y[i] - l.y);
    sum += d;
    squares += d * d;
  }
  const auto n = static_cast<float>(particles.count);
  const float mean = sum / n;
  return math::max(0.0F, squares / n - mean * mean);
}

void landmarks_of_type(const Field& field, FeatureType type, ParticleView particles, float floor, TypedLandmarks& out) {
  out.clear();
  const auto add = [&](const FieldPoint& p) {
    out.push_back({p, 0.5F / math::max(floor, distance_variance(particles, p))});
  };
  if (type == FeatureType::post) {
    for (const FieldPoint& p : field.posts()) add(p);
    return;
  }
  for (const FieldLandmark& l : field.landmarks()) {
    if (static_cast<int>(l.type) == static_cast<int>(type)) add(l.at);
  }
}

/// Exponent of eq. (5) for the landmark that explains the observation best from this pose.
float best_exponent(const TypedLandmarks& landmarks, const GroundPoint& observed, const Pose2& pose, bool range_only) {
  float best = 1e6F;
  for (const TypedLandmark& l : landmarks) {
    const GroundPoint expected = to_ground(pose, l.at);
    const float d = range_only ? math::abs(math::hypot(expected.x, expected.y) - math::hypot(observed.x, observed.y))
                               : math::hypot(expected.x - observed.x, expected.y - observed.y);
    best = math::min(best, d * l.inverse_two_variance);
  }
  return best;
}

}  // namespace

void add_paper_likelihood(const Field& field, const FeatureManager& features, const FeatureManagerConfig& config,
                          float variance_floor, int cloud, bool range_only, ParticleView particles) {
  if (particles.count == 0) return;
  ParticleView spread = particles;
  spread.count = cloud > 0 && cloud < particles.count ? cloud : particles.count;
  const float c_max = FeatureManager::saturation(config);
  for (int t = 0; t < feature_types; ++t) {
    const auto type = static_cast<FeatureType>(t);
    if (features.list(type).empty()) continue;
    TypedLandmarks landmarks;
    landmarks_of_type(field, type, spread, variance_floor, landmarks);
    if (landmarks.empty()) continue;
    for (const TrackedFeature& f : features.list(type)) {
      const float weight = f.base * f.confidence / c_max;
      for (int i = 0; i < particles.count; ++i) {
        particles.log_weight[i] -= weight * best_exponent(landmarks, f.ground, particles.pose(i), range_only);
      }
    }
  }
}

}  // namespace touchline
