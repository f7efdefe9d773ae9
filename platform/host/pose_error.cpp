// SPDX-License-Identifier: Apache-2.0
// How a pose is judged against the truth.
#include "platform/host/pose_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchline::host {
namespace {

double distance(const Pose2& a, const Pose2& b) {
  return std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                    static_cast<double>(a.y) - static_cast<double>(b.y));
}
double angle_deg(const Pose2& a, const Pose2& b) {
  return static_cast<double>(degrees(std::abs(angle_difference(a.theta, b.theta))));
}

/// Squared Mahalanobis distance of (x, y, theta), by the Cholesky factor; infinite for a covariance that is none.
double mahalanobis_squared(const Pose2& truth, const PoseEstimate& estimate) {
  const auto& c = estimate.covariance;
  const double a[3][3] = {{static_cast<double>(c.xx), static_cast<double>(c.xy), static_cast<double>(c.xt)},
                          {static_cast<double>(c.xy), static_cast<double>(c.yy), static_cast<double>(c.yt)},
                          {static_cast<double>(c.xt), static_cast<double>(c.yt), static_cast<double>(c.tt)}};
  const double d[3] = {static_cast<double>(truth.x) - static_cast<double>(estimate.pose.x),
                       static_cast<double>(truth.y) - static_cast<double>(estimate.pose.y),
                       static_cast<double>(angle_difference(truth.theta, estimate.pose.theta))};
  double l[3][3] = {};
  double z[3] = {};
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) {
      double value = a[i][j];
      for (int k = 0; k < j; ++k) value -= l[i][k] * l[j][k];
      if (i == j && !(value > 0.0)) return std::numeric_limits<double>::infinity();
      l[i][j] = i == j ? std::sqrt(value) : value / l[j][j];
    }
    z[i] = d[i];
    for (int k = 0; k < i; ++k) z[i] -= l[i][k] * z[k];
    z[i] /= l[i][i];
    sum += z[i] * z[i];
  }
  return sum;
}

bool settling(std::span<const JudgedFrame> frames, std::size_t index) {
  const double now = frames[index].time_s;
  if (now < frames.front().time_s + settling_s) return true;
  for (std::size_t i = index + 1; i-- > 0 && frames[i].time_s > now - settling_s;) {
    if (frames[i].kidnap) return true;
  }
  return false;
}

std::optional<double> time_until_back(std::span<const JudgedFrame> frames, std::size_t kidnap) {
  int in_a_row = 0;
  for (std::size_t i = kidnap; i < frames.size(); ++i) {
    if (i > kidnap && frames[i].kidnap) break;
    const auto& error = frames[i].error;
    in_a_row = error.has_pose && error.distance_m <= static_cast<double>(back_distance_m) ? in_a_row + 1 : 0;
    if (in_a_row == back_frames) {
      return frames[i + 1 - static_cast<std::size_t>(back_frames)].time_s - frames[kidnap].time_s;
    }
  }
  return std::nullopt;
}

}  // namespace

PoseError judge(const Pose2& truth, const PoseEstimate& estimate) {
  PoseError error;
  error.has_pose = estimate.valid;
  if (!estimate.valid) return error;
  error.distance_m = distance(truth, estimate.pose);
  error.angle_deg = angle_deg(truth, estimate.pose);
  const Pose2 mirror = mirrored(truth);
  const double to_mirror = distance(mirror, estimate.pose);
  error.wrong_half = to_mirror < error.distance_m && to_mirror <= static_cast<double>(wrong_half_distance_m) &&
                     angle_deg(mirror, estimate.pose) <= static_cast<double>(wrong_half_angle_deg);
  error.outside_3_sigma = mahalanobis_squared(truth, estimate) > three_sigma_squared;
  return error;
}

PoseError judge_up_to_mirror(const Pose2& truth, const PoseEstimate& estimate) {
  PoseError as_it_is = judge(truth, estimate);
  PoseError turned = judge(mirrored(truth), estimate);
  PoseError nearer = turned.distance_m < as_it_is.distance_m ? turned : as_it_is;
  nearer.wrong_half = false;
  return nearer;
}

SequenceScore judge_sequence(std::span<const JudgedFrame> frames) {
  SequenceScore score;
  double square_m = 0.0;
  double square_deg = 0.0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].kidnap) score.back_s.push_back(time_until_back(frames, i));
    if (settling(frames, i)) continue;
    ++score.counted;
    const auto& error = frames[i].error;
    if (!error.has_pose) {
      ++score.without_pose;
      continue;
    }
    square_m += error.distance_m * error.distance_m;
    square_deg += error.angle_deg * error.angle_deg;
  }
  const int with_pose = score.counted - score.without_pose;
  if (with_pose > 0) {
    score.rmse_m = std::sqrt(square_m / with_pose);
    score.rmse_deg = std::sqrt(square_deg / with_pose);
  }
  return score;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  const double part = place - static_cast<double>(low);
  if (part == 0.0 || values[low] == values[high]) return values[low];  // also keeps infinities from becoming NaN
  return values[low] + part * (values[high] - values[low]);
}

}  // namespace touchline::host
