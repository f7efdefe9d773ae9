// SPDX-License-Identifier: Apache-2.0
// Features and odometry in, pose out: the paper's sections V and VI, and the full model that goes past them.
#pragma once

#include <cstdint>

#include "loc/augmented_mcl.h"
#include "loc/clusters.h"
#include "loc/distance_field.h"
#include "loc/feature_manager.h"
#include "loc/field.h"
#include "loc/full_likelihood.h"
#include "loc/localizer_config.h"
#include "loc/observation.h"
#include "loc/particles.h"
#include "loc/pose_candidates.h"
#include "loc/pose_estimate.h"
#include "loc/refinement.h"
#include "loc/resampling.h"
#include "loc/yaw_tracker.h"
#include "platform/core/rng.h"
#include "platform/core/status.h"
#include "vision/stage.h"
#include "vision/vision_result.h"

namespace touchline {

struct LocalizerInput {
  double time_s = 0.0;
  Pose2 odometry;              // robot's step since the update before, as the gait believes it
  float unknown_xy = 0.0F;     // metres, 1 sigma: motion that no odometry reports, beyond the noise of the step
  float unknown_theta = 0.0F;  // radians, likewise
  bool has_yaw = false;
  float yaw = 0.0F;  // IMU yaw minus the stored goal yaw: theta up to noise and drift, radians
  bool moved_by_hand =
      false;  // fallen or lifted since the update before: the odometry is void, the pose may be anywhere
};

/// Limits of what one update takes. A robot in no frame for a minute has walked less; a float still tells 1 mm then.
inline constexpr float max_step_m = 100.0F;    // odometry along x and y each, and unknown_xy
inline constexpr float max_step_rad = 100.0F;  // odometry's turn, and unknown_theta: 16 turns
inline constexpr float max_angle = 1.0e4F;     // yaw and a prior's theta: a float still tells a milliradian
/// A pose farther than this from the carpet is none.
inline constexpr float max_beside_m = 3.0F;

/// Owns all memory of localization; `touchline memory` prints how much.
class Localizer {
 public:
  /// invalid_argument: a value is not finite or out of range; `what` names the key, when not null, and nothing changes.
  /// The first call asks for a reset(); a later one keeps the pose, so that thresholds can change in a match.
  Status configure(const LocalizerConfig& config, const Field& field, const char** what = nullptr);
  /// Forgets the pose and draws the particles from `prior`. The seed is the caller's: the same seed, the same poses.
  /// invalid_argument: the prior's pose or spread is not finite, beyond max_step_m, max_step_rad or max_angle, or its
  /// spread is negative; not_ready: no configure() has succeeded. Nothing changes then.
  Status reset(const Prior& prior, std::uint64_t seed);
  /// One frame. invalid_argument (a number that is not finite or beyond the limits above), not_ready (not configured or
  /// reset): nothing has changed. A time that stands still or runs backwards counts as no time: the yaw's drift is
  /// left.
  Status update(const LocalizerInput& input, const VisionResult& vision, PoseEstimate& estimate,
                StageObserver* observer = nullptr);

  [[nodiscard]] ParticleView particles() { return particles_.view(config_.particles); }
  [[nodiscard]] const FeatureManager& features() const { return features_; }
  [[nodiscard]] const LocalizerConfig& config() const { return config_; }
  [[nodiscard]] const Field& field() const { return field_; }

 private:
  /// A cluster of particles, looked at closely.
  struct Mode {
    Refinement refined;
    float evidence = 0.0F;    // nats: how well the refined pose explains the frame
    float mass = 0.0F;        // belief, sums to 1 over the modes
    bool tracked = false;     // continues the pose of the frame before
    bool negligible = false;  // not looked at closely: its particles alone are far too unlikely
  };
  using ModeList = StaticVector<Mode, max_clusters>;

  void draw_from_prior(const Prior& prior);
  void draw_around_last();
  void forget_place();
  [[nodiscard]] bool is_near_field(const PoseEstimate& estimate) const;
  [[nodiscard]] Pose2 random_pose(const YawEvidence& yaw);
  void predict(const LocalizerInput& input);
  void update_full(const VisionResult& vision, const YawEvidence& yaw, PoseEstimate& estimate);
  void update_paper(const VisionResult& vision, const YawEvidence& yaw, PoseEstimate& estimate);

  // Steps of the full model, in this order (full_model.cpp).
  float weigh_particles(const YawEvidence& yaw);
  void inject_candidates(const VisionResult& vision, const YawEvidence& yaw, float share);
  void place_candidates(const YawEvidence& yaw, float share);
  void look_for_missing(const VisionResult& vision);
  void refine_clusters(const VisionResult& vision, const YawEvidence& yaw);
  void look_closely(const Cluster& cluster, const VisionResult& vision, const YawEvidence& yaw,
                    LandmarkTerms& landmarks, Mode& mode);
  [[nodiscard]] RefinementPrior refinement_prior(const YawEvidence& yaw, bool tracked) const;
  void balance_twins(const YawEvidence& yaw);
  void share_out_mass();
  [[nodiscard]] Mode* best_mode();
  void polish_best(const YawEvidence& yaw);
  void sharpen_particles(const ClusterIndex& index);
  void resample(const YawEvidence& yaw, float random_share);
  void report_full(PoseEstimate& estimate);
  void settle(PoseEstimate& estimate, float spread_m, float spread_rad);

  LocalizerConfig config_{};
  Field field_{};
  DistanceField map_{};
  Rng rng_{0};
  ParticleStorage<max_particles> particles_{};
  ResamplingStorage<max_particles> resampling_{};
  Observation observation_{};
  CandidateList candidates_{};
  ClusterList clusters_{};
  ClusterIndex cluster_index_{};
  ModeList modes_{};
  FeatureManager features_{};
  AugmentedMcl augmented_{};
  YawTracker yaw_{};
  PoseEstimate last_{};  // the pose of the frame before, moved by odometry
  double last_time_s_ = 0.0;
  int frames_ = 0;         // since the reset
  float belief_ = 0.0F;    // in the best mode, up to the mirror: what decides whether to search
  int cloud_ = 0;          // particles that came through the last resampling; the rest were drawn at random
  int steady_frames_ = 0;  // in a row with a sure pose that did not move
  bool configured_ = false;
};

}  // namespace touchline
