// SPDX-License-Identifier: Apache-2.0
#include "loc/full_likelihood.h"

#include "loc/robust.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

/// Cost of one observed point landmark against the best of the field's own.
struct Match {
  float z2 = 1e6F;
};

float normalised_square(const GroundPoint& seen, const Sym2& covariance, const GroundPoint& expected, float extra) {
  const float xx = covariance.xx + extra * extra;
  const float yy = covariance.yy + extra * extra;
  const float xy = covariance.xy;
  const float det = math::max(xx * yy - xy * xy, 1e-9F);
  const float dx = seen.x - expected.x;
  const float dy = seen.y - expected.y;
  return (yy * dx * dx - 2.0F * xy * dx * dy + xx * dy * dy) / det;
}

constexpr float direction_sigma = 0.2F;  // radians: a branch of half a metre measured on a line 10 cm wide

/// to_ground() for many points and one pose: its sine and cosine are taken once.
struct Ground {
  explicit Ground(const Pose2& from) : pose(from), turn(math::sin_cos(from.theta)) {}
  [[nodiscard]] GroundPoint point(const FieldPoint& p) const {
    const float dx = p.x - pose.x;
    const float dy = p.y - pose.y;
    return {turn.cos * dx + turn.sin * dy, turn.cos * dy - turn.sin * dx};
  }
  Pose2 pose;
  math::SinCos turn;
};

float junction_cost(const Field& field, const Junction& j, const Ground& ground, float extra) {
  Match best;
  for (const FieldLandmark& l : field.landmarks()) {
    if (l.type != j.type) continue;
    float z2 = normalised_square(j.ground, j.covariance, ground.point(l.at), extra);
    if (z2 >= best.z2) continue;
    float turn = angle_difference(j.direction[0] + ground.pose.theta, l.direction[0]);
    if (j.type == JunctionType::x) turn = angle_difference(4.0F * turn, 0.0F) * 0.25F;  // four-fold
    z2 += math::square(turn / direction_sigma);
    if (z2 < best.z2) best.z2 = z2;
  }
  return j.confidence * robust_cost(best.z2);
}

float circle_cost(const CircleObservation& circle, const Ground& ground, float extra) {
  float z2 = normalised_square(circle.centre, circle.covariance, ground.point({0.0F, 0.0F}), extra);
  if (circle.has_half_line) {
    const float turn = angle_difference(2.0F * (circle.half_line_direction + ground.pose.theta), math::pi) * 0.5F;
    z2 += math::square(turn / direction_sigma);
  }
  return circle.confidence * robust_cost(z2);
}

float post_cost(const Field& field, const PostObservation& post, const Ground& ground, float extra) {
  float z2 = 1e6F;
  for (const FieldPoint& p : field.posts()) {
    z2 = math::min(z2, normalised_square(post.ground, post.covariance, ground.point(p), extra));
  }
  return post.confidence * robust_cost(z2);
}

}  // namespace

float yaw_z2(const YawEvidence& yaw, float theta) {
  return yaw.known ? math::square(angle_difference(theta, yaw.theta) / yaw.sigma) : 0.0F;
}

float yaw_log_likelihood(const YawEvidence& yaw, float theta) {
  const float z2 = yaw_z2(yaw, theta);
  return -math::min(0.5F * z2, 12.5F + 0.05F * z2);
}

float line_log_likelihood(const DistanceField& map, const Observation& observation, const Pose2& pose,
                          float extra_sigma) {
  const auto [s, c] = math::sin_cos(pose.theta);
  float sum = 0.0F;
  for (const LineSample& p : observation.filter_lines) {
    const float x = pose.x + c * p.ground.x - s * p.ground.y;
    const float y = pose.y + s * p.ground.x + c * p.ground.y;
    const float dx = c * p.dir_x - s * p.dir_y;
    const float dy = s * p.dir_x + c * p.dir_y;
    const float d = map.distance_inline({x, y}, axis_of(dx, dy));
    const float variance = p.variance + extra_sigma * extra_sigma;
    sum -= p.weight * robust_cost(d * d / variance);
  }
  return sum;
}

float landmark_log_likelihood(const Field& field, const Observation& observation, Landmarks landmarks,
                              const Pose2& pose, float extra_sigma) {
  float sum = 0.0F;
  if (observation.features == nullptr) return sum;
  const Features& f = *observation.features;
  const Ground ground(pose);
  if (landmarks != Landmarks::goalposts) {
    for (const Junction& j : f.junctions) sum -= junction_cost(field, j, ground, extra_sigma);
    if (f.has_circle) sum -= circle_cost(f.circle, ground, extra_sigma);
  }
  if (landmarks != Landmarks::lines) {
    for (const PostObservation& p : f.posts) sum -= post_cost(field, p, ground, extra_sigma);
  }
  return sum;
}

}  // namespace touchline
