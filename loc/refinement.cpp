// SPDX-License-Identifier: Apache-2.0
#include "loc/refinement.h"

#include "loc/distance_field.h"
#include "loc/robust.h"
#include "loc/small_solver.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

/// The two axes about which pitch and roll turn the camera, in the robot's axes.
struct TiltAxes {
  Vec3 pitch;
  Vec3 roll;
};
TiltAxes tilt_axes(const CameraPose& camera) {
  const Mat3 yaw = rotation_z(camera.yaw);
  const Mat3 yaw_pitch = multiply(yaw, rotation_y(camera.pitch));
  return {multiply(yaw, Vec3{0.0F, 1.0F, 0.0F}), multiply(yaw_pitch, Vec3{1.0F, 0.0F, 0.0F})};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

struct State {
  Pose2 pose;
  float pitch = 0.0F;
  float roll = 0.0F;
};

/// Ground point of a sample under the state's tilt, and its derivatives by pitch and roll. Small angles: first order.
struct TiltedPoint {
  float x, y;
  float x_pitch, y_pitch;
  float x_roll, y_roll;
};
bool tilt_point(const LineSample& s, const CameraPose& camera, const TiltAxes& axes, const State& state,
                TiltedPoint& out) {
  const Vec3 dp = cross(axes.pitch, s.ray);
  const Vec3 dr = cross(axes.roll, s.ray);
  const Vec3 r{s.ray.x + state.pitch * dp.x + state.roll * dr.x, s.ray.y + state.pitch * dp.y + state.roll * dr.y,
               s.ray.z + state.pitch * dp.z + state.roll * dr.z};
  if (r.z > -0.02F) return false;  // within about a degree of the horizon a point says nothing
  const float inverse_z = 1.0F / r.z;
  const float scale = -camera.height * inverse_z;
  out.x = camera.x + scale * r.x;
  out.y = camera.y + scale * r.y;
  const float k = -camera.height * inverse_z * inverse_z;
  out.x_pitch = k * (dp.x * r.z - r.x * dp.z);
  out.y_pitch = k * (dp.y * r.z - r.y * dp.z);
  out.x_roll = k * (dr.x * r.z - r.x * dr.z);
  out.y_roll = k * (dr.y * r.z - r.y * dr.z);
  return true;
}

struct Sums {
  NormalEquations normal;
  float log_likelihood = 0.0F;
  float explained = 0.0F;
  float weight = 0.0F;
};

/// One linearisation: residual = distance to the nearest line of the right direction; `base` is added to every sigma
/// while the pose is still rough.
Sums linearise(const Field& field, std::span<const LineSample> samples, const CameraPose& camera, const TiltAxes& axes,
               const State& state, float base, float reach) {
  Sums sums;
  const auto [sn, c] = math::sin_cos(state.pose.theta);
  for (const LineSample& s : samples) {
    sums.weight += s.weight;
    const float sigma = math::hypot(s.sigma, base);
    TiltedPoint g{};
    LineMatch line;
    bool near = tilt_point(s, camera, axes, state, g);
    if (near) {
      line = nearest_line(field, {state.pose.x + c * g.x - sn * g.y, state.pose.y + sn * g.x + c * g.y},
                          c * s.dir_x - sn * s.dir_y, sn * s.dir_x + c * s.dir_y);
      near = math::abs(line.distance) < math::max(reach, 4.0F * sigma);
    }
    if (!near) {
      sums.log_likelihood -= s.weight * robust_limit;
      continue;
    }
    const float z2 = math::square(line.distance / sigma);
    const float pull = robust_weight(z2);
    sums.log_likelihood -= s.weight * robust_cost(z2);
    sums.explained += s.weight * pull;
    const float w = s.weight * pull / (sigma * sigma);
    const float nx = line.normal_x;
    const float ny = line.normal_y;
    const float rx = c * nx + sn * ny;  // normal in the robot's frame
    const float ry = -sn * nx + c * ny;
    const PoseVector j = {nx, ny, nx * (-sn * g.x - c * g.y) + ny * (c * g.x - sn * g.y),
                          rx * g.x_pitch + ry * g.y_pitch, rx * g.x_roll + ry * g.y_roll};
    sums.normal.add(j, line.distance, w);
  }
  return sums;
}

void add_prior(const RefinementPrior& prior, const State& state, NormalEquations& normal) {
  const float tilt = 1.0F / math::square(prior.tilt_sigma);
  normal.add_single(3, state.pitch, tilt);
  normal.add_single(4, state.roll, tilt);
  if (prior.has_yaw) {
    normal.add_single(2, angle_difference(state.pose.theta, prior.yaw), 1.0F / math::square(prior.yaw_sigma));
  }
  if (prior.has_pose) {
    PoseCovariance information;
    if (invert(prior.covariance, information)) {
      const float e[3] = {state.pose.x - prior.pose.x, state.pose.y - prior.pose.y,
                          angle_difference(state.pose.theta, prior.pose.theta)};
      normal.add_block3(information, e);
    }
  }
  // A weak pull to where the state is keeps the system solvable when all lines seen are parallel (sigma 0.5 m, 20 deg).
  normal.add_single(0, 0.0F, 4.0F);
  normal.add_single(1, 0.0F, 4.0F);
  normal.add_single(2, 0.0F, 8.0F);
}

}  // namespace

Refinement refine_pose(const Field& field, std::span<const LineSample> samples, const CameraPose& camera,
                       const Pose2& start, const RefinementPrior& prior, float reach, int steps) {
  const TiltAxes axes = tilt_axes(camera);
  State state{start, 0.0F, 0.0F};
  Refinement out;
  float base = 0.25F * reach;  // graduated: a line pulls from afar at first, and from close by in the end
  for (int i = 0; i < steps; ++i) {
    Sums sums = linearise(field, samples, camera, axes, state, base, 4.0F * base);
    base *= 0.6F;
    add_prior(prior, state, sums.normal);
    PoseVector step;
    if (!sums.normal.solve(step)) return out;
    state.pose.x -= step[0];
    state.pose.y -= step[1];
    state.pose.theta = wrap_angle(state.pose.theta - step[2]);
    state.pitch -= step[3];
    state.roll -= step[4];
    out.converged = math::abs(step[0]) + math::abs(step[1]) < 0.01F && math::abs(step[2]) < 0.01F;
  }
  Sums last = linearise(field, samples, camera, axes, state, 0.0F, 0.0F);
  add_prior(prior, state, last.normal);
  out.pose = state.pose;
  out.pitch_error = state.pitch;
  out.roll_error = state.roll;
  out.converged = last.normal.pose_covariance(out.covariance) && out.converged;
  out.line_log_likelihood = last.log_likelihood;
  out.explained = last.weight > 0.0F ? last.explained / last.weight : 0.0F;
  return out;
}

}  // namespace touchline
