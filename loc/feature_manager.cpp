// SPDX-License-Identifier: Apache-2.0
#include "loc/feature_manager.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

float base_likelihood(FeatureType type, const FeatureManagerConfig& c) {
  switch (type) {
    case FeatureType::l: return c.base_l;
    case FeatureType::t: return c.base_t;
    case FeatureType::x: return c.base_x;
    case FeatureType::post: return c.base_post;
  }
  return 0.0F;
}

/// 1 on the optical axis, one half at config.axis_half_angle: the picture is worse toward its edge (paper section VII).
float axis_share(const VisionResult& vision, const PixelPoint& pixel, const FeatureManagerConfig& c) {
  Vec3 ray;
  if (!vision.projection.lens().ray(pixel, ray)) return 0.0F;
  const float ratio = math::acos(ray.z) / c.axis_half_angle;
  return 1.0F / (1.0F + ratio * ratio);
}

GroundPoint moved(const GroundPoint& p, const Pose2& step) { return to_ground(step, FieldPoint{p.x, p.y}); }

float nearest_of_type(const Field& field, FeatureType type, const FieldPoint& p) {
  float best = 1e6F;
  const auto offer = [&](const FieldPoint& l) { best = math::min(best, math::hypot(l.x - p.x, l.y - p.y)); };
  if (type == FeatureType::post) {
    for (const FieldPoint& post : field.posts()) offer(post);
  } else {
    for (const FieldLandmark& l : field.landmarks()) {
      if (static_cast<int>(l.type) == static_cast<int>(type)) offer(l.at);
    }
  }
  return best;
}

void decay_and_forget(FeatureList& list, const Pose2& step, const FeatureManagerConfig& config, float decay,
                      FeatureManagerCounts& counts) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    TrackedFeature f = list[i];
    f.ground = moved(f.ground, step);
    f.confidence *= decay;
    if (f.confidence < config.threshold) {
      ++counts.forgotten;
    } else {
      list[kept++] = f;
    }
  }
  list.truncate(kept);
}

}  // namespace

float FeatureManager::saturation(const FeatureManagerConfig& config) {
  return 1.0F / (1.0F - math::exp(-1.0F / config.gamma));
}

void FeatureManager::clear() {
  for (FeatureList& list : lists_) list.clear();
}

void FeatureManager::update(const Pose2& odometry, const VisionResult& vision, Landmarks landmarks, const Field& field,
                            const Pose2* pose, const FeatureManagerConfig& config) {
  counts_ = {};
  const float decay = math::exp(-1.0F / config.gamma);  // eq. (1), one frame at a time
  for (FeatureList& list : lists_) decay_and_forget(list, odometry, config, decay, counts_);
  if (vision.features == nullptr) return;
  if (landmarks != Landmarks::goalposts) {
    for (const Junction& j : vision.features->junctions) {
      const auto type = static_cast<FeatureType>(j.type);
      const float base = base_likelihood(type, config) * j.confidence * axis_share(vision, j.pixel, config);
      sight(type, j.ground, base, field, pose, config);
    }
  }
  if (landmarks != Landmarks::lines) {
    for (const PostObservation& p : vision.features->posts) {
      const float base = config.base_post * p.confidence * axis_share(vision, p.pixel, config);
      sight(FeatureType::post, p.ground, base, field, pose, config);
    }
  }
}

void FeatureManager::sight(FeatureType type, const GroundPoint& ground, float base, const Field& field,
                           const Pose2* pose, const FeatureManagerConfig& config) {
  ++counts_.sightings;
  // Farther features are measured worse: the gate grows with the range beyond two metres.
  const float growth = math::max(1.0F, 0.5F * math::hypot(ground.x, ground.y));
  if (pose != nullptr && nearest_of_type(field, type, to_field(*pose, ground)) > growth * config.validation_gate_m) {
    ++counts_.turned_down;
    return;
  }
  FeatureList& list = lists_[static_cast<std::size_t>(type)];
  TrackedFeature* same = nullptr;
  float best = growth * config.gate_m;
  for (TrackedFeature& f : list.span()) {
    const float d = math::hypot(f.ground.x - ground.x, f.ground.y - ground.y);
    if (d < best) {
      best = d;
      same = &f;
    }
  }
  if (same != nullptr) {
    // The mean over the sightings, but never slower than one part in five: odometry smears what is remembered.
    const float share = math::max(1.0F / (same->confidence + 1.0F), 0.2F);
    same->ground.x += share * (ground.x - same->ground.x);
    same->ground.y += share * (ground.y - same->ground.y);
    same->confidence += 1.0F;
    same->base = base;
  } else if (!list.push_back({ground, 1.0F, base})) {
    ++counts_.dropped;
  }
}

}  // namespace touchline
