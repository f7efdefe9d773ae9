// SPDX-License-Identifier: Apache-2.0
// The rules by which poses are judged, on hand-made numbers.
#include "platform/host/pose_error.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

namespace touchline::host {
namespace {

PoseEstimate estimate_at(float x, float y, float theta_deg, float sigma = 0.1F) {
  PoseEstimate e;
  e.valid = true;
  e.pose = {x, y, radians(theta_deg)};
  e.covariance.xx = sigma * sigma;
  e.covariance.yy = sigma * sigma;
  e.covariance.tt = sigma * sigma;
  return e;
}

TEST_CASE("distance and absolute angle, over the wrap") {
  const PoseError error = judge({1.0F, 2.0F, radians(179.0F)}, estimate_at(1.3F, 2.4F, -178.0F));
  CHECK(error.has_pose);
  CHECK(error.distance_m == doctest::Approx(0.5));
  CHECK(error.angle_deg == doctest::Approx(3.0).epsilon(1e-4));
  CHECK_FALSE(error.wrong_half);
  CHECK_FALSE(judge({}, PoseEstimate{}).has_pose);
}

TEST_CASE("the wrong half is near the mirrored truth, in place and angle") {
  const Pose2 truth{1.0F, 0.5F, 0.0F};
  CHECK(judge(truth, estimate_at(-1.1F, -0.6F, 175.0F)).wrong_half);
  CHECK_FALSE(judge(truth, estimate_at(-1.1F, -0.6F, 140.0F)).wrong_half);  // 40 degrees off
  CHECK_FALSE(judge(truth, estimate_at(-1.5F, -0.5F, 180.0F)).wrong_half);  // 0.5 m off
  CHECK_FALSE(judge(truth, estimate_at(1.0F, 0.5F, 180.0F)).wrong_half);
  CHECK_FALSE(judge({0.05F, 0.0F, radians(90.0F)}, estimate_at(0.1F, 0.0F, -90.0F)).wrong_half);  // nearer to the truth
}

TEST_CASE("up to the mirror the nearer of both counts") {
  const Pose2 truth{1.0F, 0.5F, 0.0F};
  const PoseError error = judge_up_to_mirror(truth, estimate_at(-1.03F, -0.54F, 178.0F));
  CHECK(error.distance_m == doctest::Approx(0.05).epsilon(1e-3));
  CHECK(error.angle_deg == doctest::Approx(2.0).epsilon(1e-3));
  CHECK_FALSE(error.wrong_half);
  CHECK(judge_up_to_mirror(truth, estimate_at(1.0F, 0.5F, 0.0F)).distance_m == doctest::Approx(0.0));
}

TEST_CASE("3 sigma is the Mahalanobis distance, with correlations") {
  CHECK_FALSE(judge({}, estimate_at(0.37F, 0.0F, 0.0F, 0.1F)).outside_3_sigma);  // 3.7 sigma: 13.7 < 14.156
  CHECK(judge({}, estimate_at(0.38F, 0.0F, 0.0F, 0.1F)).outside_3_sigma);
  PoseEstimate narrow = estimate_at(0.1F, -0.1F, 0.0F, 0.1F);
  CHECK_FALSE(judge({}, narrow).outside_3_sigma);
  narrow.covariance.xy = 0.0099F;  // x and y err together; this error has them apart
  CHECK(judge({}, narrow).outside_3_sigma);
  narrow.covariance.xx = 0.0F;  // no covariance at all: never inside
  CHECK(judge({}, narrow).outside_3_sigma);
}

JudgedFrame frame(double t, double distance, bool kidnap = false, bool has_pose = true) {
  JudgedFrame f;
  f.time_s = t;
  f.kidnap = kidnap;
  f.error.has_pose = has_pose;
  f.error.distance_m = distance;
  f.error.angle_deg = distance * 10.0;
  return f;
}

TEST_CASE("a sequence leaves out the first second and the second after a kidnap") {
  std::vector<JudgedFrame> frames;
  for (int i = 0; i < 40; ++i) {
    const double t = i * 0.1;
    const bool settling = t < 0.999 || (t > 1.999 && t < 2.999);
    frames.push_back(frame(t, settling ? 5.0 : (i % 2 == 0 ? 0.3 : 0.4), i == 20));
  }
  const SequenceScore score = judge_sequence(frames);
  CHECK(score.counted == 20);
  CHECK(score.without_pose == 0);
  CHECK(score.rmse_m == doctest::Approx(std::sqrt((0.09 + 0.16) / 2)));
  CHECK(score.rmse_deg == doctest::Approx(10 * std::sqrt((0.09 + 0.16) / 2)));
  REQUIRE(score.back_s.size() == 1);
  CHECK_FALSE(score.back_s[0].has_value());  // 0.3 m is not back
}

TEST_CASE("back is the first of five in a row, and a frame without a pose breaks the row") {
  std::vector<JudgedFrame> frames{frame(0.0, 0.0), frame(1.0, 3.0, true), frame(1.1, 0.1), frame(1.2, 0.1),
                                  frame(1.3, 0.1, false, false)};
  for (int i = 0; i < 4; ++i) frames.push_back(frame(1.4 + 0.1 * i, 0.2));
  CHECK_FALSE(judge_sequence(frames).back_s[0].has_value());
  frames.push_back(frame(1.8, 0.0));
  REQUIRE(judge_sequence(frames).back_s[0].has_value());
  CHECK(*judge_sequence(frames).back_s[0] == doctest::Approx(0.4));
}

TEST_CASE("frames without a pose are counted and leave the RMSE alone") {
  const std::vector<JudgedFrame> frames{frame(0.0, 9.0), frame(1.5, 0.1), frame(1.6, 0.0, false, false)};
  const SequenceScore score = judge_sequence(frames);
  CHECK(score.counted == 2);
  CHECK(score.without_pose == 1);
  CHECK(score.rmse_m == doctest::Approx(0.1));
}

TEST_CASE("quantiles interpolate, and infinities stay what they are") {
  const double infinite = std::numeric_limits<double>::infinity();
  CHECK(quantile({3.0, 1.0, 2.0}, 0.5) == 2.0);
  CHECK(quantile({4.0, 1.0, 2.0, 3.0}, 0.5) == 2.5);
  CHECK(quantile({1.0, infinite, infinite}, 0.75) == infinite);
  CHECK(quantile({1.0, 2.0, infinite}, 1.0) == infinite);
  CHECK(std::isnan(quantile({}, 0.5)));
}

}  // namespace
}  // namespace touchline::host
