// SPDX-License-Identifier: Apache-2.0
// The full model: particles carry the belief; each of their clusters is refined by Gauss-Newton on the line points, and
// judged by what the refined pose explains and by what it says must be there and is not. Mass is shared out among the
// clusters by that evidence, and particles are drawn anew about the refined poses.
#include <algorithm>
#include <array>

#include "loc/localizer.h"
#include "loc/motion_model.h"
#include "loc/resampling.h"
#include "loc/visibility.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float cluster_radius_m = 0.30F;
constexpr float cluster_angle = radians(15.0F);
constexpr float particle_sigma = 0.10F;       // m: spacing of particles about a mode
constexpr float range_for_visibility = 3.0F;  // m: beyond, worn lines are missed too often to be held against a pose
constexpr float missing_nats_per_metre = 4.0F;
constexpr float temper = 0.5F;            // measurements share the frame's errors: half of what independence would give
constexpr float max_step_nats = 5.0F;     // what one frame may say at most: one bad frame must not lose the pose
constexpr float search_share = 0.10F;     // of AMCL: from here on the frame's own candidates are looked for
constexpr float negligible_mass = 1e-5F;  // by the particles' own weights: not worth a closer look
constexpr float blind_decay = 0.9F;       // of confidence, with nothing in view
constexpr float vague_sigma = 0.40F;      // m: a pose known no better than this has half the confidence
// Gauss-Newton: steps, and how far a line may be from a sample to be its own. A pose carried on from the frame before
// is near; a cluster's mean is as far off as the cluster is wide; the best mode, seen on all samples at last, has
// arrived.
constexpr int tracking_steps = 5, search_steps = 8, polish_steps = 3;
constexpr float tracking_gate = 0.20F, search_gate = 0.40F, polish_gate = 0.05F;  // m
constexpr float refined_sigma = 0.05F;        // m: what a refined pose may still be off a landmark's own error
constexpr float first_share = 0.5F;           // of particles, from the first frame's candidates
constexpr float unsure_share = 0.25F;         // likewise, while the pose is not sure
constexpr float largest_random_share = 0.3F;  // the rest keeps the belief
constexpr float candidate_spread_m = 0.08F;   // of a candidate's second and later particles
constexpr float candidate_spread_rad = 0.05F;
constexpr float same_place_m = 0.15F, same_angle = radians(8.0F);   // two modes on one pose
constexpr float twin_place_m = 0.40F, twin_angle = radians(20.0F);  // a mode that may be the pose's mirror image
constexpr float tracked_favour = 2.0F;      // a mirrored twin of equal mass must not make the pose flip
constexpr float stray_log_weight = -20.0F;  // of a particle outside of all clusters

struct Factor {  // lower-triangular square root of a 3x3 covariance
  float l00, l10, l11, l20, l21, l22;
};
Factor square_root(const PoseCovariance& c) {
  Factor f{};
  f.l00 = math::sqrt(math::max(c.xx, 1e-8F));
  f.l10 = c.xy / f.l00;
  f.l11 = math::sqrt(math::max(c.yy - f.l10 * f.l10, 1e-8F));
  f.l20 = c.xt / f.l00;
  f.l21 = (c.yt - f.l20 * f.l10) / f.l11;
  f.l22 = math::sqrt(math::max(c.tt - f.l20 * f.l20 - f.l21 * f.l21, 1e-8F));
  return f;
}

/// Log likelihoods of particles' poses, sixteen at a time.
class PoseJudge {
 public:
  PoseJudge(const Field& field, const DistanceField& map, const Observation& observation, const LocalizerConfig& config,
            const YawEvidence& yaw)
      : yaw_(yaw), kernels_(config.kernels) {
    prepare_lines(map, observation, particle_sigma, 1, lines_);
    prepare_landmarks(field, observation, config.landmarks, particle_sigma, landmarks_);
  }
  /// `line_costs`: nats >= 0, the line points' part of it. Both have room for sixteen.
  void judge(const PoseBlock& poses, float* line_costs, float* log_likelihoods) {
    float landmark_costs[pose_lanes];
    kernels_.line_costs(lines_, poses, line_costs);
    kernels_.landmark_costs(landmarks_, poses, landmark_costs);
    for (int i = 0; i < poses.count; ++i) {
      log_likelihoods[i] = yaw_log_likelihood(yaw_, poses.theta[i]) - temper * (line_costs[i] + landmark_costs[i]);
    }
  }

 private:
  const YawEvidence& yaw_;
  const LocKernels& kernels_;
  LineTerms lines_;
  LandmarkTerms landmarks_;
};

/// Of the position: the larger eigenvalue of its 2x2 covariance.
float largest_variance(const PoseCovariance& c) {
  const float mean = 0.5F * (c.xx + c.yy);
  return mean + math::hypot(0.5F * (c.xx - c.yy), c.xy);
}

bool near(const Pose2& a, const Pose2& b, float distance, float angle) {
  return math::hypot(a.x - b.x, a.y - b.y) < distance && math::abs(angle_difference(a.theta, b.theta)) < angle;
}

}  // namespace

void Localizer::update_full(const VisionResult& vision, const YawEvidence& yaw, PoseEstimate& estimate) {
  const float average = weigh_particles(yaw);
  if (observation_.line_weight > 1.0F) augmented_.update(average, config_.augmented);
  const float share = frames_ == 0 ? first_share : augmented_.random_share(config_.augmented);
  const bool unsure = !last_.valid || belief_ < config_.confident;
  if (unsure || share > search_share) inject_candidates(vision, yaw, math::max(share, unsure ? unsure_share : 0.0F));
  find_clusters(particles(), cluster_radius_m, cluster_angle, resampling_.weights.data(), clusters_, cluster_index_);
  refine_clusters(vision, yaw);
  balance_twins(yaw);
  share_out_mass();
  sharpen_particles(cluster_index_);
  polish_best(yaw);
  report_full(estimate);
  settle(estimate, 0.01F, radians(0.5F));
  resample(yaw, math::min(share, largest_random_share));
}

// Functions with a judge are never inlined: it is four kilobytes of stack, which the rest of a frame has no use for.

/// Log likelihood of every particle; returns the mean over the particles of the likelihood per measurement, in (0, 1].
[[gnu::noinline]] float Localizer::weigh_particles(const YawEvidence& yaw) {
  PoseJudge judge(field_, map_, observation_, config_, yaw);
  const ParticleView p = particles();
  float sum = 0.0F;
  const float per_measurement = 1.0F / math::max(observation_.line_weight, 1.0F);
  for (int first = 0; first < p.count; first += pose_lanes) {
    PoseBlock block;
    take_poses(p, first, config_.kernels, block);
    float line_costs[pose_lanes];
    judge.judge(block, line_costs, p.log_weight + first);
    for (int i = 0; i < block.count; ++i) sum += math::exp(-line_costs[i] * per_measurement);
  }
  return sum / static_cast<float>(p.count);
}

/// Puts the frame's own candidates in place of every n-th particle, `share` of all: resampling keeps the order, so that
/// a run of neighbours is one mode, and would lose it to chance. Candidates that put lines where there are none have
/// been moved to the end: with little in view many places explain what is seen, and few what is not.
void Localizer::inject_candidates(const VisionResult& vision, const YawEvidence& yaw, float share) {
  find_candidates(field_, map_, observation_, config_, yaw, candidates_);
  if (candidates_.empty()) return;
  look_for_missing(vision);
  place_candidates(yaw, share);
}

[[gnu::noinline]] void Localizer::place_candidates(const YawEvidence& yaw, float share) {
  const ParticleView p = particles();
  const int count = std::max(1, part_of(p.count, math::min(share, 0.5F)));
  PoseJudge judge(field_, map_, observation_, config_, yaw);
  PoseBlock block;
  std::array<int, pose_lanes> at{};
  std::array<float, pose_lanes> missing{};
  const auto weigh = [&] {
    float line_costs[pose_lanes], log_likelihoods[pose_lanes];
    judge.judge(block, line_costs, log_likelihoods);
    for (std::size_t i = 0; i < static_cast<std::size_t>(block.count); ++i) {
      p.log_weight[at[i]] = log_likelihoods[i] - temper * missing[i];
    }
    block.count = 0;
  };
  for (int k = 0; k < count; ++k) {
    const PoseCandidate& c = candidates_[static_cast<std::size_t>(k) % std::min(candidates_.size(), max_clusters)];
    const int i = k * p.count / count;
    Pose2 pose = c.pose;
    if (k >= static_cast<int>(max_clusters)) {
      pose.x += candidate_spread_m * rng_.gaussian();
      pose.y += candidate_spread_m * rng_.gaussian();
      pose.theta = wrap_angle(pose.theta + candidate_spread_rad * rng_.gaussian());
    }
    p.set_pose(i, pose);
    at[static_cast<std::size_t>(block.count)] = i;
    missing[static_cast<std::size_t>(block.count)] = c.missing;
    block.push_back(pose);
    if (block.count == pose_lanes) weigh();
  }
  if (block.count > 0) weigh();
}

/// Takes off each score what the lines cost that are missing from the picture, and leaves the best first. What only
/// ever lowers a score need not be known of those that are behind as many as are used already.
void Localizer::look_for_missing(const VisionResult& vision) {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    PoseCandidate candidate = candidates_[i];
    if (i >= max_clusters && candidate.score <= candidates_[max_clusters - 1].score) {
      candidates_.truncate(i);
      return;
    }
    Refinement as_given;
    as_given.pose = candidate.pose;
    candidate.missing =
        missing_nats_per_metre * check_visibility(field_, vision, as_given, range_for_visibility).missing;
    candidate.score -= candidate.missing;
    std::size_t k = i;
    for (; k > 0 && candidates_[k - 1].score < candidate.score; --k) candidates_[k] = candidates_[k - 1];
    candidates_[k] = candidate;
  }
}

RefinementPrior Localizer::refinement_prior(const YawEvidence& yaw, bool tracked) const {
  RefinementPrior prior;
  prior.tilt_sigma = config_.tilt_sigma;
  prior.has_yaw = yaw.known;
  prior.yaw = yaw.theta;
  prior.yaw_sigma = yaw.sigma;
  prior.has_pose = tracked;
  prior.pose = last_.pose;
  prior.covariance = last_.covariance;
  return prior;
}

void Localizer::refine_clusters(const VisionResult& vision, const YawEvidence& yaw) {
  modes_.clear();
  LandmarkTerms landmarks;
  prepare_landmarks(field_, observation_, config_.landmarks, refined_sigma, landmarks);
  for (const Cluster& cluster : clusters_) {
    Mode mode;
    mode.negligible = cluster.mass < negligible_mass;
    mode.refined.pose = cluster.mean;
    mode.refined.covariance = cluster.covariance;
    if (!mode.negligible) look_closely(cluster, vision, yaw, landmarks, mode);
    modes_.push_back(mode);
  }
}

void Localizer::look_closely(const Cluster& cluster, const VisionResult& vision, const YawEvidence& yaw,
                             LandmarkTerms& landmarks, Mode& mode) {
  mode.tracked = last_.valid && near(cluster.mean, last_.pose, cluster_radius_m, cluster_angle);
  if (observation_.line_weight >= 1.0F) {  // else there is nothing to refine on, and the particles know best
    const Refinement refined =
        refine_pose(quarter_lines(field_), observation_.filter_lines.view(), observation_.camera,
                    mode.tracked ? last_.pose : cluster.mean, refinement_prior(yaw, mode.tracked), config_.kernels,
                    mode.tracked ? tracking_gate : search_gate, mode.tracked ? tracking_steps : search_steps);
    if (refined.converged) {
      mode.refined = refined;
    } else {
      LineTerms lines;
      prepare_lines(map_, observation_, 0.0F, 1, lines);
      mode.refined.line_log_likelihood = line_log_likelihood(lines, cluster.mean, config_.kernels);
    }
  }
  const Refinement& r = mode.refined;
  const Visibility look = check_visibility(field_, vision, r, range_for_visibility);
  mode.evidence = temper * (r.line_log_likelihood - missing_nats_per_metre * look.missing +
                            landmark_log_likelihood(landmarks, r.pose, config_.kernels)) +
                  yaw_log_likelihood(yaw, r.pose.theta) -
                  0.5F * (math::square(r.pitch_error) + math::square(r.roll_error)) / math::square(config_.tilt_sigma);
}

/// The field is its own mirror image: nothing in a picture tells a pose from its mirrored twin, and what the numbers
/// seem to say is noise that would pick a half by chance, frame by frame. Only the yaw may differ.
void Localizer::balance_twins(const YawEvidence& yaw) {
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    for (std::size_t k = i + 1; k < modes_.size(); ++k) {
      Mode& a = modes_[i];
      Mode& b = modes_[k];
      if (a.negligible || b.negligible || !near(a.refined.pose, mirrored(b.refined.pose), same_place_m, same_angle))
        continue;
      const float yaw_a = yaw_log_likelihood(yaw, a.refined.pose.theta);
      const float yaw_b = yaw_log_likelihood(yaw, b.refined.pose.theta);
      const float picture = math::max(a.evidence - yaw_a, b.evidence - yaw_b);
      a.evidence = picture + yaw_a;
      b.evidence = picture + yaw_b;
    }
  }
}

Localizer::Mode* Localizer::best_mode() {
  if (modes_.empty()) return nullptr;
  const auto favour = [this](std::size_t i) { return modes_[i].mass * (modes_[i].tracked ? tracked_favour : 1.0F); };
  std::size_t best = 0;
  for (std::size_t i = 1; i < modes_.size(); ++i) {
    if (favour(i) > favour(best)) best = i;
  }
  return &modes_[best];
}

void Localizer::polish_best(const YawEvidence& yaw) {
  Mode* best = best_mode();
  if (best == nullptr || !best->refined.converged) return;
  const Refinement refined =
      refine_pose(quarter_lines(field_), observation_.lines.view(), observation_.camera, best->refined.pose,
                  refinement_prior(yaw, best->tracked), config_.kernels, polish_gate, polish_steps);
  if (refined.converged) best->refined = refined;
}

/// Belief of a mode: its particles before this frame, times what the frame says of its refined pose.
void Localizer::share_out_mass() {
  float best = -1e9F;
  for (const Mode& m : modes_) {
    if (!m.negligible) best = math::max(best, m.evidence);
  }
  float sum = 0.0F;
  for (std::size_t i = 0; i < modes_.size(); ++i) {
    const float prior = static_cast<float>(clusters_[i].count) / static_cast<float>(config_.particles);
    const float difference = modes_[i].negligible ? -max_step_nats : modes_[i].evidence - best;
    modes_[i].mass = prior * math::exp(math::max(difference, -max_step_nats));
    sum += modes_[i].mass;
  }
  for (Mode& m : modes_) m.mass = sum > 0.0F ? m.mass / sum : 0.0F;
}

/// Every cluster's particles share its mass evenly, and stand about its refined pose.
void Localizer::sharpen_particles(const ClusterIndex& index) {
  const ParticleView p = particles();
  std::size_t last = no_cluster;  // neighbours are mostly of one cluster
  float log_weight = stray_log_weight;
  Factor f{};
  Noise noise;
  for (int i = 0; i < p.count; ++i) {
    if (i % noise_block == 0) draw_noise(config_.kernels, rng_, noise);
    const std::size_t k = index[static_cast<std::size_t>(i)];
    if (k == no_cluster) {
      p.log_weight[i] = stray_log_weight;
      continue;
    }
    const Mode& m = modes_[k];
    if (k != last) {
      last = k;
      const auto count = static_cast<float>(clusters_[k].count);
      log_weight = math::log(math::max(m.mass / math::max(count, 1.0F), 1e-12F));
      f = square_root(m.refined.covariance);
    }
    p.log_weight[i] = log_weight;
    if (!m.refined.converged) continue;
    const int at = i % noise_block;
    const float a = noise.value[0][at];
    const float b = noise.value[1][at];
    const float c = noise.value[2][at];
    p.set_pose(i, {m.refined.pose.x + f.l00 * a, m.refined.pose.y + f.l10 * a + f.l11 * b,
                   wrap_angle(m.refined.pose.theta + f.l20 * a + f.l21 * b + f.l22 * c)});
  }
}

void Localizer::resample(const YawEvidence& yaw, float random_share) {
  const ParticleView p = particles();
  const int fresh = part_of(p.count, random_share);
  resample_low_variance(p, p.count - fresh, resampling_.memory(), rng_);
  for (int i = p.count - fresh; i < p.count; ++i) {
    p.set_pose(i, random_pose(yaw));
    p.log_weight[i] = 0.0F;
  }
}

void Localizer::report_full(PoseEstimate& estimate) {
  estimate = {};
  const Mode* best = best_mode();
  if (best == nullptr || (observation_.line_weight < 0.5F && !last_.valid)) return;
  estimate.valid = true;
  estimate.pose = best->refined.pose;
  estimate.covariance = best->refined.covariance;
  estimate.explained = best->refined.explained;
  estimate.pitch_error = best->refined.pitch_error;
  estimate.roll_error = best->refined.roll_error;
  const Pose2 twin = mirrored(estimate.pose);
  float mass = 0.0F;
  for (const Mode& m : modes_) {
    if (near(m.refined.pose, twin, twin_place_m, twin_angle)) {
      estimate.has_mirror = true;
      estimate.mirror = m.refined.pose;
      estimate.mirror_confidence += m.mass;
    } else if (near(m.refined.pose, estimate.pose, same_place_m, same_angle)) {
      mass += m.mass;
    } else {  // law of total variance, taken about the best mode
      const float dx = m.refined.pose.x - estimate.pose.x;
      const float dy = m.refined.pose.y - estimate.pose.y;
      const float dt = angle_difference(m.refined.pose.theta, estimate.pose.theta);
      estimate.covariance.xx += m.mass * dx * dx;
      estimate.covariance.xy += m.mass * dx * dy;
      estimate.covariance.yy += m.mass * dy * dy;
      estimate.covariance.xt += m.mass * dx * dt;
      estimate.covariance.yt += m.mass * dy * dt;
      estimate.covariance.tt += m.mass * dt * dt;
    }
  }
  const float quality = observation_.line_weight < 1.0F ? blind_decay : math::min(1.0F, 1.5F * best->refined.explained);
  // Along a lone line the pose is open: belief in a mode is one thing, to know where in it the robot stands another.
  const float known = 1.0F / (1.0F + largest_variance(estimate.covariance) / math::square(vague_sigma));
  belief_ = quality * (mass + estimate.mirror_confidence);
  estimate.confidence = quality * known * mass;
  estimate.mirror_confidence *= quality * known;
}

}  // namespace touchline
