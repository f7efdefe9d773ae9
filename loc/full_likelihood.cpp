// SPDX-License-Identifier: Apache-2.0
#include "loc/full_likelihood.h"

#include <cassert>

#include "loc/robust.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float direction_sigma = 0.2F;  // radians: a branch of half a metre measured on a line 10 cm wide

constexpr LandmarkTerms::Place nowhere = {1e4F, 1e4F, 0.0F};

using Sight = LandmarkTerms::Sight;

/// A sight without a direction. The covariance is widened by `extra` and inverted.
Sight sight_of(const GroundPoint& seen, const Sym2& covariance, float extra, float confidence) {
  Sight s;
  s.x = seen.x;
  s.y = seen.y;
  const float xx = covariance.xx + extra * extra;
  const float yy = covariance.yy + extra * extra;
  const float xy = covariance.xy;
  const float inverse_det = 1.0F / math::max(xx * yy - xy * xy, 1e-9F);
  s.xx = yy * inverse_det;
  s.xy = -2.0F * xy * inverse_det;
  s.yy = xx * inverse_det;
  s.period = math::two_pi;
  s.confidence = confidence;
  return s;
}

void give_direction(Sight& s, float direction, float period) {
  s.direction = direction;
  s.period = period;
  s.turn_weight = 1.0F / direction_sigma;
}

void add_sight(LandmarkTerms& t, Sight s, int first) {
  s.first = s.begin = first;
  s.last = t.place_count;
  t.sights[t.sight_count++] = s;
}

void prepare_junctions(const Field& field, const Features& f, float extra, LandmarkTerms& out) {
  for (const JunctionType type : {JunctionType::l, JunctionType::t, JunctionType::x}) {
    const int first = out.place_count;
    for (const FieldLandmark& l : field.landmarks()) {
      if (l.type == type) out.places[out.place_count++] = {l.at.x, l.at.y, l.direction[0]};
    }
    if (out.place_count == first) out.places[out.place_count++] = nowhere;  // the field has none of these
    for (const Junction& j : f.junctions) {
      if (j.type != type) continue;
      Sight s = sight_of(j.ground, j.covariance, extra, j.confidence);
      give_direction(s, j.direction[0], type == JunctionType::x ? math::half_pi : math::two_pi);
      add_sight(out, s, first);
    }
  }
}

}  // namespace

void PoseBlock::push_back(const Pose2& pose) {
  assert(count < pose_lanes);
  const auto [s, c] = math::sin_cos(pose.theta);
  x[count] = pose.x;
  y[count] = pose.y;
  theta[count] = pose.theta;
  sin[count] = s;
  cos[count] = c;
  ++count;
}

float yaw_z2(const YawEvidence& yaw, float theta) {
  return yaw.known ? math::square(angle_difference(theta, yaw.theta) / yaw.sigma) : 0.0F;
}

float yaw_log_likelihood(const YawEvidence& yaw, float theta) {
  const float z2 = yaw_z2(yaw, theta);
  return -math::min(0.5F * z2, 12.5F + 0.05F * z2);
}

void prepare_lines(const DistanceField& map, const Observation& observation, float extra_sigma, std::size_t step,
                   LineTerms& out) {
  out.map = map.cells();
  const float per_metre = out.map.nodes_a_metre;
  constexpr float square_steps = 1.0F / (DistanceField::unit * DistanceField::unit);  // a square metre
  int n = 0;
  for (std::size_t i = 0; i < observation.filter_lines.size(); i += step) {
    const LineSample p = observation.filter_lines[i];
    out.x[n] = p.ground.x * per_metre;
    out.y[n] = p.ground.y * per_metre;
    out.double_cos[n] = p.dir_x * p.dir_x - p.dir_y * p.dir_y;
    out.double_sin[n] = 2.0F * p.dir_x * p.dir_y;
    out.saturation[n] = 2.0F * robust_limit * square_steps * (p.variance + extra_sigma * extra_sigma);
    out.limit[n] = robust_limit * p.weight;
    ++n;
  }
  out.count = n;
}

void prepare_landmarks(const Field& field, const Observation& observation, Landmarks landmarks, float extra_sigma,
                       LandmarkTerms& out) {
  out.place_count = 0;
  out.sight_count = 0;
  if (observation.features == nullptr) return;
  const Features& f = *observation.features;
  if (landmarks != Landmarks::goalposts) {
    prepare_junctions(field, f, extra_sigma, out);
    if (f.has_circle) {
      out.places[out.place_count++] = {0.0F, 0.0F, math::half_pi};  // the half line runs along y
      Sight s = sight_of(f.circle.centre, f.circle.covariance, extra_sigma, f.circle.confidence);
      if (f.circle.has_half_line) give_direction(s, f.circle.half_line_direction, math::pi);
      add_sight(out, s, out.place_count - 1);
    }
  }
  if (landmarks != Landmarks::lines) {
    const int first = out.place_count;
    for (const FieldPoint& p : field.posts()) out.places[out.place_count++] = {p.x, p.y, 0.0F};
    for (const PostObservation& p : f.posts) {
      add_sight(out, sight_of(p.ground, p.covariance, extra_sigma, p.confidence), first);
    }
  }
}

float line_log_likelihood(const LineTerms& terms, const Pose2& pose, const LocKernels& kernels) {
  PoseBlock block;
  block.push_back(pose);
  float costs[pose_lanes];
  kernels.line_costs(terms, block, costs);
  return -costs[0];
}

float landmark_log_likelihood(LandmarkTerms& terms, const Pose2& pose, const LocKernels& kernels) {
  PoseBlock block;
  block.push_back(pose);
  float costs[pose_lanes];
  kernels.landmark_costs(terms, block, costs);
  return -costs[0];
}

}  // namespace touchline
