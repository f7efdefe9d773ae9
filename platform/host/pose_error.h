// SPDX-License-Identifier: Apache-2.0
// How a pose is judged against the truth: the rules of the data sets' format, and nothing of the localizer's own.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "loc/localizer.h"
#include "platform/core/geometry.h"

namespace touchline::host {

inline constexpr float wrong_half_distance_m = 0.4F;  // to the mirrored truth
inline constexpr float wrong_half_angle_deg = 30.0F;
inline constexpr double settling_s = 1.0;  // after the start and after a kidnap: does not count for the RMSE
inline constexpr int back_frames = 5;      // in a row
inline constexpr float back_distance_m = 0.20F;
/// The truth is outside 3 sigma when its squared Mahalanobis distance in (x, y, theta) is larger than the value that a
/// Gaussian of three dimensions exceeds as often as one dimension exceeds 3 sigma: 0.27 %.
inline constexpr double three_sigma_squared = 14.156;

struct PoseError {
  bool has_pose = false;
  double distance_m = 0.0;  // void without a pose; likewise below
  double angle_deg = 0.0;   // absolute
  bool wrong_half = false;
  bool outside_3_sigma = false;
};

PoseError judge(const Pose2& truth, const PoseEstimate& estimate);
/// As judge(), of the nearer of the pose and its mirror image: for tests without a yaw, where nothing tells the halves.
PoseError judge_up_to_mirror(const Pose2& truth, const PoseEstimate& estimate);

/// One frame of a sequence as the judge sees it.
struct JudgedFrame {
  double time_s = 0.0;
  bool kidnap = false;
  PoseError error;
};

struct SequenceScore {
  int counted = 0;                                           // frames that count
  int without_pose = 0;                                      // of those
  double rmse_m = std::numeric_limits<double>::quiet_NaN();  // over those with a pose; NaN: there are none
  double rmse_deg = std::numeric_limits<double>::quiet_NaN();
  /// For each kidnap: seconds until the pose is back, nothing when it never is (before the next kidnap).
  std::vector<std::optional<double>> back_s;
};
SequenceScore judge_sequence(std::span<const JudgedFrame> frames);

/// The value that `share` (0..1) of the sorted values do not exceed, by linear interpolation; NaN for none.
double quantile(std::vector<double> values, double share);

}  // namespace touchline::host
