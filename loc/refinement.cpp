// SPDX-License-Identifier: Apache-2.0
#include "loc/refinement.h"

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

struct State {
  Pose2 pose;
  float pitch = 0.0F;
  float roll = 0.0F;
};

/// One linearisation: residual = distance to the nearest line of the right direction; `base` is added to every sigma
/// while the pose is still rough.
struct Linearisation {
  NormalEquations normal;
  RefineSums sums;
};
Linearisation linearise(RefineTerms& terms, const State& state, float base, const LocKernels& kernels) {
  const auto [s, c] = math::sin_cos(state.pose.theta);
  terms.pose = state.pose;
  terms.sin = s;
  terms.cos = c;
  terms.pitch = state.pitch;
  terms.roll = state.roll;
  terms.extra_variance = base * base;
  Linearisation out;
  kernels.linearise(terms, out.sums);
  out.normal.add_sums(out.sums.hessian, out.sums.gradient);
  return out;
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

QuarterLines quarter_lines(const Field& field) {
  QuarterLines out;
  const auto take = [](std::span<const AxisLine> lines, QuarterLines::Line* to) {
    int n = 0;
    for (const AxisLine& line : lines) {
      if (line.across >= 0.0F && line.high > 0.0F) to[n++] = {math::max(line.low, 0.0F), line.high, line.across};
    }
    return n;
  };
  out.along_x_count = take(field.lines_along_x(), out.along_x);
  out.along_y_count = take(field.lines_along_y(), out.along_y);
  out.circle_radius = field.dimensions().circle_radius;
  return out;
}

Refinement refine_pose(const QuarterLines& lines, const LineSampleView& samples, const CameraPose& camera,
                       const Pose2& start, const RefinementPrior& prior, const LocKernels& kernels, float reach,
                       int steps) {
  const TiltAxes axes = tilt_axes(camera);
  RefineTerms terms{samples, lines, camera, axes.pitch, axes.roll, {}};
  State state{start, 0.0F, 0.0F};
  Refinement out;
  float base = 0.25F * reach;  // graduated: a line pulls from afar at first, and from close by in the end
  for (int i = 0; i < steps; ++i) {
    Linearisation linear = linearise(terms, state, base, kernels);
    base *= 0.6F;
    add_prior(prior, state, linear.normal);
    PoseVector step;
    if (!linear.normal.solve(step)) return out;
    state.pose.x -= step[0];
    state.pose.y -= step[1];
    state.pose.theta = wrap_angle(state.pose.theta - step[2]);
    state.pitch -= step[3];
    state.roll -= step[4];
    out.converged = math::abs(step[0]) + math::abs(step[1]) < 0.01F && math::abs(step[2]) < 0.01F;
  }
  Linearisation last = linearise(terms, state, 0.0F, kernels);
  add_prior(prior, state, last.normal);
  out.pose = state.pose;
  out.pitch_error = state.pitch;
  out.roll_error = state.roll;
  out.converged = last.normal.pose_covariance(out.covariance) && out.converged;
  out.line_log_likelihood = -last.sums.cost;
  out.explained = last.sums.weight > 0.0F ? last.sums.explained / last.sums.weight : 0.0F;
  return out;
}

}  // namespace touchline
