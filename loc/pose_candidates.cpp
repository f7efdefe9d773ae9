// SPDX-License-Identifier: Apache-2.0
#include "loc/pose_candidates.h"

#include <array>

#include "loc/robust.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float coarse_sigma = 0.15F;  // m: half the spacing of the grid, diagonal, and what a tilt does to a junction
constexpr float same_distance = 0.35F;
constexpr float same_angle = radians(20.0F);
constexpr float grid_step = 0.25F;

bool same_place(const Pose2& a, const Pose2& b) {
  return math::square(a.x - b.x) + math::square(a.y - b.y) < same_distance * same_distance &&
         math::abs(angle_difference(a.theta, b.theta)) < same_angle;
}

bool on_carpet(const Field& field, const Pose2& p) {
  return math::abs(p.x) <= field.half_carpet_length() + 0.3F && math::abs(p.y) <= field.half_carpet_width() + 0.3F;
}

/// Keeps the list sorted and free of near duplicates.
void offer(const PoseCandidate& c, CandidateList& list) {
  for (PoseCandidate& other : list.span()) {
    if (!same_place(other.pose, c.pose)) continue;
    if (c.score > other.score) other = c;
    return;
  }
  if (!list.full()) {
    list.push_back(c);
    return;
  }
  PoseCandidate* worst = list.begin();
  for (PoseCandidate& other : list.span()) {
    if (other.score < worst->score) worst = &other;
  }
  if (c.score > worst->score) *worst = c;
}

struct Search {
  const Field& field;
  const DistanceField& map;
  const Observation& observation;
  Landmarks landmarks;
  const YawEvidence& yaw;
  CandidateList& out;

  void consider(const Pose2& pose, CandidateSource source) {
    if (!on_carpet(field, pose) || yaw_z2(yaw, pose.theta) > 25.0F) return;
    const float score = line_log_likelihood(map, observation, pose, coarse_sigma) +
                        landmark_log_likelihood(field, observation, landmarks, pose, coarse_sigma) +
                        yaw_log_likelihood(yaw, pose.theta);
    offer({pose, score, source}, out);
  }

  /// The pose that puts `seen` (robot's frame) onto `at` with heading `theta`.
  static Pose2 pose_from_point(const GroundPoint& seen, const FieldPoint& at, float theta) {
    const float c = math::cos(theta);
    const float s = math::sin(theta);
    return {at.x - (c * seen.x - s * seen.y), at.y - (s * seen.x + c * seen.y), wrap_angle(theta)};
  }

  void from_junction(const Junction& j) {
    const int turns = j.type == JunctionType::x ? 4 : 1;
    for (const FieldLandmark& l : field.landmarks()) {
      if (l.type != j.type) continue;
      for (int k = 0; k < turns; ++k) {
        const float theta = l.direction[0] - j.direction[0] + static_cast<float>(k) * math::half_pi;
        consider(pose_from_point(j.ground, l.at, theta), CandidateSource::junction);
      }
    }
  }

  void from_circle(const CircleObservation& circle) {
    if (circle.has_half_line) {
      for (const float half_line : {math::half_pi, -math::half_pi}) {
        consider(pose_from_point(circle.centre, {}, half_line - circle.half_line_direction), CandidateSource::circle);
      }
    } else if (yaw.known) {
      consider(pose_from_point(circle.centre, {}, yaw.theta), CandidateSource::circle);
    }
  }

  void from_posts(const Features& features) {
    if (!yaw.known) return;
    for (const PostObservation& post : features.posts) {
      for (const FieldPoint& p : field.posts()) {
        consider(pose_from_point(post.ground, p, yaw.theta), CandidateSource::junction);
      }
    }
  }

  void from_grid(float theta) {
    const int nx = static_cast<int>(field.half_carpet_length() / grid_step);
    const int ny = static_cast<int>(field.half_carpet_width() / grid_step);
    for (int i = -nx; i <= nx; ++i) {
      for (int k = -ny; k <= ny; ++k) {
        consider({static_cast<float>(i) * grid_step, static_cast<float>(k) * grid_step, theta}, CandidateSource::grid);
      }
    }
  }
};

/// Direction of most of the seen line, modulo a right angle, in [0, pi/2): peak of a histogram of 3 degree bins.
/// False when there are no lines.
bool dominant_direction(const Observation& observation, float& out) {
  constexpr int bins = 30;
  std::array<float, bins> histogram{};
  for (const LineSample& s : observation.lines) {
    float a = math::atan2(s.dir_y, s.dir_x);
    if (a < 0.0F) a += math::pi;
    if (a >= math::half_pi) a -= math::half_pi;
    const int bin = static_cast<int>(a * (bins / math::half_pi));
    histogram[static_cast<std::size_t>(bin < 0 ? 0 : bin % bins)] += s.weight;
  }
  int best = -1;
  float best_sum = 0.0F;
  float offset = 0.0F;
  for (int i = 0; i < bins; ++i) {
    const float before = histogram[static_cast<std::size_t>((i + bins - 1) % bins)];
    const float here = histogram[static_cast<std::size_t>(i)];
    const float after = histogram[static_cast<std::size_t>((i + 1) % bins)];
    const float sum = before + here + after;
    if (sum > best_sum) {
      best = i;
      best_sum = sum;
      offset = (after - before) / sum;
    }
  }
  if (best < 0) return false;
  out = (static_cast<float>(best) + 0.5F + offset) * (math::half_pi / bins);
  return true;
}

void sort_best_first(CandidateList& list) {  // insertion sort: at most 32
  for (std::size_t i = 1; i < list.size(); ++i) {
    const PoseCandidate c = list[i];
    std::size_t k = i;
    for (; k > 0 && list[k - 1].score < c.score; --k) list[k] = list[k - 1];
    list[k] = c;
  }
}

}  // namespace

void find_candidates(const Field& field, const DistanceField& map, const Observation& observation, Landmarks landmarks,
                     const YawEvidence& yaw, CandidateList& out) {
  out.clear();
  if (observation.features == nullptr) return;
  Search search{field, map, observation, landmarks, yaw, out};
  if (landmarks != Landmarks::goalposts) {
    for (const Junction& j : observation.features->junctions) search.from_junction(j);
    if (observation.features->has_circle) search.from_circle(observation.features->circle);
    float direction = 0.0F;
    if (dominant_direction(observation, direction)) {
      for (int k = 0; k < 4; ++k) {
        const float theta = wrap_angle(static_cast<float>(k) * math::half_pi - direction);
        if (yaw_z2(yaw, theta) < 25.0F) search.from_grid(theta);
      }
    }
  }
  if (landmarks != Landmarks::lines) search.from_posts(*observation.features);
  sort_best_first(out);
}

}  // namespace touchline
