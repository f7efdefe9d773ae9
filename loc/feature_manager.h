// SPDX-License-Identifier: Apache-2.0
// The feature manager (paper section V-A, eq. (1)): remembers features on the ground in the robot's frame, moves them
// with the odometry, lets confidence decay, and turns down what a sure pose says cannot be there.
#pragma once

#include "loc/field.h"
#include "loc/localizer_config.h"
#include "platform/core/static_vector.h"
#include "vision/vision_result.h"

namespace touchline {

enum class FeatureType : std::uint8_t { l, t, x, post };
inline constexpr int feature_types = 4;

struct TrackedFeature {
  GroundPoint ground;       // robot's frame, now
  float confidence = 0.0F;  // c of eq. (1): +1 a sighting, times exp(-1 / gamma) a frame; saturates at about gamma
  float base = 0.0F;        // likelihood of the type, times the share for its distance from the polar axis, times
                            // what vision itself thinks of this sighting
};

/// Features of one type that are remembered: the field's own (at most 16 of a type) and as many bogus ones.
inline constexpr std::size_t max_tracked_features = 32;
using FeatureList = StaticVector<TrackedFeature, max_tracked_features>;

struct FeatureManagerCounts {
  int sightings = 0;    // reported by vision in this frame
  int turned_down = 0;  // by validation
  int forgotten = 0;    // confidence below the threshold
  int dropped = 0;      // no room in the list
};

class FeatureManager {
 public:
  /// One frame. `pose` is the present pose when it is sure, else null: without one nothing is turned down.
  void update(const Pose2& odometry, const VisionResult& vision, Landmarks landmarks, const Field& field,
              const Pose2* pose, const FeatureManagerConfig& config);
  /// After a recovery or a reset: what was remembered belongs to another pose.
  void clear();

  [[nodiscard]] const FeatureList& list(FeatureType type) const { return lists_[static_cast<std::size_t>(type)]; }
  [[nodiscard]] const FeatureManagerCounts& counts() const { return counts_; }
  /// The confidence at which eq. (1) saturates when a feature is seen in every frame: 1 / (1 - exp(-1 / gamma)).
  [[nodiscard]] static float saturation(const FeatureManagerConfig& config);

 private:
  void sight(FeatureType type, const GroundPoint& ground, float base, const Field& field, const Pose2* pose,
             const FeatureManagerConfig& config);

  std::array<FeatureList, feature_types> lists_{};
  FeatureManagerCounts counts_{};
};

}  // namespace touchline
