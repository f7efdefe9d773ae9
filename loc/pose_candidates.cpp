// SPDX-License-Identifier: Apache-2.0
#include "loc/pose_candidates.h"

#include <algorithm>
#include <array>

#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float coarse_sigma = 0.15F;  // m: half the spacing of the grid, diagonal, and what a tilt does to a junction
constexpr float same_distance = 0.35F;
constexpr float same_angle = radians(20.0F);
constexpr float grid_step = 0.25F;
// The best known come first, and one that is real is enough: more are seen at once by clutter alone.
constexpr std::size_t max_junctions_tried = 12;
constexpr std::size_t grid_samples = 48;  // of filter_lines: a coarse look needs no more
// The widest field with 2 m of border on either side, and a column of nothing at either end.
constexpr std::size_t max_grid_columns = static_cast<std::size_t>((max_field_width + 4.0F) / grid_step) + 4;

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

class Search {
 public:
  Search(const Field& field, const DistanceField& map, const Observation& observation, const LocalizerConfig& config,
         const YawEvidence& yaw, CandidateList& out)
      : field_(field), yaw_(yaw), kernels_(config.kernels), out_(out) {
    prepare_lines(map, observation, coarse_sigma, 1, lines_);
    prepare_landmarks(field, observation, config.landmarks, coarse_sigma, landmarks_);
    prepare_lines(map, observation, coarse_sigma, (observation.filter_lines.size() + grid_samples - 1) / grid_samples,
                  few_lines_);
  }

  /// Scores come eight poses at a time: the last ones wait for this.
  void finish() {
    float lines[pose_lanes];
    float landmarks[pose_lanes];
    kernels_.line_costs(lines_, waiting_, lines);
    kernels_.landmark_costs(landmarks_, waiting_, landmarks);
    for (int i = 0; i < waiting_.count; ++i) {
      const Pose2 pose{waiting_.x[i], waiting_.y[i], waiting_.theta[i]};
      offer({pose, yaw_log_likelihood(yaw_, pose.theta) - (lines[i] + landmarks[i]), 0.0F, sources_[i]}, out_);
    }
    waiting_.count = 0;
  }

  void consider(const Pose2& pose, CandidateSource source) {
    if (!on_carpet(field_, pose) || yaw_z2(yaw_, pose.theta) > 25.0F) return;
    sources_[waiting_.count] = source;
    waiting_.push_back(pose);
    if (waiting_.count == pose_lanes) finish();
  }

  /// The pose that puts `seen` (robot's frame) onto `at` with heading `theta`.
  static Pose2 pose_from_point(const GroundPoint& seen, const FieldPoint& at, float theta) {
    const float c = math::cos(theta);
    const float s = math::sin(theta);
    return {at.x - (c * seen.x - s * seen.y), at.y - (s * seen.x + c * seen.y), wrap_angle(theta)};
  }

  void from_junction(const Junction& j) {
    const int turns = j.type == JunctionType::x ? 4 : 1;
    for (const FieldLandmark& l : field_.landmarks()) {
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
    } else if (yaw_.known) {
      consider(pose_from_point(circle.centre, {}, yaw_.theta), CandidateSource::circle);
    }
  }

  void from_posts(const Features& features) {
    if (!yaw_.known) return;
    for (const PostObservation& post : features.posts) {
      for (const FieldPoint& p : field_.posts()) {
        consider(pose_from_point(post.ground, p, yaw_.theta), CandidateSource::junction);
      }
    }
  }

  /// Minus the cost of the lines at a column of positions on the grid, from `low` on in steps of the grid.
  void grid_scores(float x, int low, int count, float theta, float* scores) const {
    const auto [s, c] = math::sin_cos(theta);
    for (int k = 0; k < count; k += pose_lanes) {
      PoseBlock block;
      block.count = std::min(pose_lanes, count - k);
      for (int i = 0; i < block.count; ++i) {
        block.x[i] = x;
        block.y[i] = static_cast<float>(low + k + i) * grid_step;
        block.sin[i] = s;
        block.cos[i] = c;
      }
      float costs[pose_lanes];
      kernels_.line_costs(few_lines_, block, costs);
      for (int i = 0; i < block.count; ++i) scores[k + i] = -costs[i];
    }
  }

  /// Only local maxima over the eight neighbours are considered in full: three rows of scores are enough to see them.
  void from_grid(float theta) {
    const int nx = static_cast<int>(field_.half_carpet_length() / grid_step);
    const int ny = static_cast<int>(field_.half_carpet_width() / grid_step);
    const int columns = 2 * ny + 1;
    std::array<std::array<float, max_grid_columns>, 3> rows;
    for (auto& row : rows) row.fill(-1e9F);
    for (int i = -nx; i <= nx + 1; ++i) {
      auto& newest = rows[static_cast<std::size_t>((i + nx + 2) % 3)];
      if (i > nx) {
        newest.fill(-1e9F);
      } else {
        grid_scores(static_cast<float>(i) * grid_step, -ny, columns, theta, newest.data() + 1);
      }
      const auto& middle = rows[static_cast<std::size_t>((i + nx + 1) % 3)];
      const auto& oldest = rows[static_cast<std::size_t>((i + nx) % 3)];
      for (int k = 1; k <= columns && i > -nx; ++k) {
        if (!is_peak(oldest, middle, newest, static_cast<std::size_t>(k))) continue;
        consider({static_cast<float>(i - 1) * grid_step, static_cast<float>(k - 1 - ny) * grid_step, theta},
                 CandidateSource::grid);
      }
    }
  }

  using GridRow = std::array<float, max_grid_columns>;
  static bool is_peak(const GridRow& above, const GridRow& row, const GridRow& below, std::size_t k) {
    const float here = row[k];
    return here > row[k - 1] && here >= row[k + 1] && here > above[k - 1] && here > above[k] && here > above[k + 1] &&
           here >= below[k - 1] && here >= below[k] && here >= below[k + 1];
  }

 private:
  PoseBlock waiting_;
  LineTerms lines_, few_lines_;
  LandmarkTerms landmarks_;
  const Field& field_;
  const YawEvidence& yaw_;
  const LocKernels& kernels_;
  CandidateList& out_;
  CandidateSource sources_[pose_lanes] = {};
};

/// Direction of most of the seen line, modulo a right angle, in [0, pi/2): peak of a histogram of 3 degree bins.
/// False when there are no lines.
bool dominant_direction(const Observation& observation, float& out) {
  constexpr int bins = 30;
  std::array<float, bins> histogram{};
  const LineSampleView samples = observation.lines.view();
  for (int i = 0; i < samples.count; ++i) {
    float a = math::atan2(samples.dir_y[i], samples.dir_x[i]);
    if (a < 0.0F) a += math::pi;
    if (a >= math::half_pi) a -= math::half_pi;
    const int bin = static_cast<int>(a * (bins / math::half_pi));
    histogram[static_cast<std::size_t>(bin < 0 ? 0 : bin % bins)] += samples.weight[i];
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

[[gnu::noinline]] void find_candidates(const Field& field, const DistanceField& map, const Observation& observation,
                                       const LocalizerConfig& config, const YawEvidence& yaw, CandidateList& out) {
  out.clear();
  if (observation.features == nullptr) return;
  Search search(field, map, observation, config, yaw, out);
  if (config.landmarks != Landmarks::goalposts) {
    const std::span<const Junction> junctions = observation.features->junctions.span();
    for (const Junction& j : junctions.first(std::min(junctions.size(), max_junctions_tried))) search.from_junction(j);
    if (observation.features->has_circle) search.from_circle(observation.features->circle);
    float direction = 0.0F;
    if (dominant_direction(observation, direction)) {
      for (int k = 0; k < 4; ++k) {
        const float theta = wrap_angle(static_cast<float>(k) * math::half_pi - direction);
        if (yaw_z2(yaw, theta) < 25.0F) search.from_grid(theta);
      }
    }
  }
  if (config.landmarks != Landmarks::lines) search.from_posts(*observation.features);
  search.finish();
  sort_best_first(out);
}

}  // namespace touchline
