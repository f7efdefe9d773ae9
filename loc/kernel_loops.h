// SPDX-License-Identifier: Apache-2.0
// The loops of kernels.h, for one lane or eight. Included by files of kernels alone, as lanes_loops.h is.
#pragma once

#include "loc/kernels.h"
#include "loc/robust.h"
#include "platform/core/lanes_loops.h"

namespace touchline {
namespace {

// --- Line samples against the distance map -------------------------------------------------------------------------

/// Lanes are poses.
template <class L>
[[gnu::always_inline]] inline typename L::F line_cost(const LineTerms& t, const PoseBlock& poses, int lane) {
  using F = typename L::F;
  using I = typename L::I;
  const F s = load<L>(poses.sin + lane);
  const F c = load<L>(poses.cos + lane);
  const F px = load<L>(poses.x + lane) * t.map.nodes_a_metre;
  const F py = load<L>(poses.y + lane) * t.map.nodes_a_metre;
  const F double_cos = c * c - s * s;
  const F double_sin = 2.0F * c * s;
  const F last_column = all<L>(t.map.last_column);
  const F last_row = all<L>(t.map.last_row);
  const I along_y = I{} + t.map.layer;
  F sum = all<L>(0.0F);
  for (int i = 0; i < t.count; ++i) {
    const F u = magnitude(px + (c * t.x[i] - s * t.y[i])) + 0.5F;
    const F v = magnitude(py + (s * t.x[i] + c * t.y[i])) + 0.5F;
    const I cell = truncated(least(v, last_row)) * t.map.columns + truncated(least(u, last_column));
    // |cos| >= |sin| of the direction on the field: the line runs along x.
    const auto is_x = double_cos * t.double_cos[i] - double_sin * t.double_sin[i] >= 0.0F;
    const F steps = byte_at(t.map.nodes, cell + choose(is_x, I{}, along_y));
    const F square = steps * steps;
    sum += t.limit[i] * square / (t.saturation[i] + square);
  }
  return sum;
}

template <class L>
void line_costs(const LineTerms& terms, const PoseBlock& poses, float* costs) {
  for (int lane = 0; lane < poses.count; lane += L::lanes) store(costs + lane, line_cost<L>(terms, poses, lane));
}

// --- Landmarks -------------------------------------------------------------------------------------------------------

/// An angle's distance to the nearest whole number of periods.
template <class F>
[[gnu::always_inline]] inline F modulo(F angle, float period) {
  const F turns = angle * (1.0F / period);
  return angle - as_float(truncated(turns + with_sign(F{} + 0.5F, turns))) * period;
}

/// Lanes are poses.
template <class L>
[[gnu::always_inline]] inline typename L::F landmark_cost(LandmarkTerms& t, const PoseBlock& poses, int lane) {
  using F = typename L::F;
  const F s = load<L>(poses.sin + lane);
  const F c = load<L>(poses.cos + lane);
  const F px = load<L>(poses.x + lane);
  const F py = load<L>(poses.y + lane);
  const F theta = load<L>(poses.theta + lane);
  F x[max_places];
  F y[max_places];
  for (int k = 0; k < t.place_count; ++k) {  // into the robot's frame
    const LandmarkTerms::Place& place = t.places[k];
    const F dx = place.x - px;
    const F dy = place.y - py;
    x[k] = c * dx + s * dy;
    y[k] = c * dy - s * dx;
  }
  F sum = all<L>(0.0F);
  for (int j = 0; j < t.sight_count; ++j) {
    LandmarkTerms::Sight& sight = t.sights[j];
    const F heading = theta + sight.direction;
    F best = all<L>(1e6F);
    int nearest = sight.begin;
    // The nearest place is the same for most poses: begun with, it spares the angle to all others.
    for (int k = sight.first - 1; k < sight.last; ++k) {
      const int at = k < sight.first ? sight.begin : k;
      const F dx = sight.x - x[at];
      const F dy = sight.y - y[at];
      F z2 = dx * (sight.xx * dx + sight.xy * dy) + sight.yy * dy * dy;
      if (!any(z2 < best)) continue;
      const F turn = modulo(heading - t.places[at].direction, sight.period) * sight.turn_weight;
      z2 += turn * turn;
      const auto closer = z2 < best;
      if (!any(closer)) continue;
      best = choose(closer, z2, best);
      nearest = at;
    }
    sight.begin = nearest;
    sum += sight.confidence * (0.5F * best / (1.0F + best * (0.5F / robust_limit)));
  }
  return sum;
}

template <class L>
void landmark_costs(LandmarkTerms& terms, const PoseBlock& poses, float* costs) {
  for (int lane = 0; lane < poses.count; lane += L::lanes) store(costs + lane, landmark_cost<L>(terms, poses, lane));
}

// --- Linearisation of the line samples -----------------------------------------------------------------------------

template <class L>
struct Vector3 {
  typename L::F x, y, z;
};
template <class L>
[[gnu::always_inline]] inline Vector3<L> cross_axis(const Vec3& a, const Vector3<L>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The nearest line: distance, and the normal from it, in the field's frame.
template <class L>
struct Match {
  typename L::F distance, normal_x, normal_y;
};

template <class L>
struct NearestSoFar {
  typename L::F square, across, beyond;
};

template <class L>
[[gnu::always_inline]] inline void look_along(const QuarterLines::Line* lines, int count, typename L::M where,
                                              typename L::F along, typename L::F across, NearestSoFar<L>& best) {
  using F = typename L::F;
  for (int k = 0; k < count; ++k) {
    const F off = across - lines[k].across;
    const F beyond = along - least(most(along, all<L>(lines[k].low)), all<L>(lines[k].high));
    const F square = off * off + beyond * beyond;
    const auto closer = where & (square < best.square);
    best.square = choose(closer, square, best.square);
    best.across = choose(closer, off, best.across);
    best.beyond = choose(closer, beyond, best.beyond);
  }
}

/// Among the lines of the direction's axis, and the circle where its tangent is within 45 degrees of the direction.
template <class L>
[[gnu::always_inline]] inline Match<L> nearest_of(const QuarterLines& lines, typename L::F x, typename L::F y,
                                                  typename L::F dx, typename L::F dy) {
  using F = typename L::F;
  const auto is_x = magnitude(dx) >= magnitude(dy);
  const F quarter_x = magnitude(x);
  const F quarter_y = magnitude(y);
  const F along = choose(is_x, quarter_x, quarter_y);
  const F across = choose(is_x, quarter_y, quarter_x);
  NearestSoFar<L> best{all<L>(1e9F), all<L>(31622.0F), all<L>(0.0F)};
  if (any(is_x)) look_along<L>(lines.along_x, lines.along_x_count, is_x, along, across, best);
  const auto is_y = magnitude(dx) < magnitude(dy);
  if (any(is_y)) look_along<L>(lines.along_y, lines.along_y_count, is_y, along, across, best);
  F distance = best.across;
  F normal_across = all<L>(1.0F);
  F normal_along = all<L>(0.0F);
  const auto past_end = best.beyond != 0.0F;
  if (any(past_end)) {
    const F far = choose(past_end, root(best.square), all<L>(1.0F));
    distance = choose(past_end, far, distance);
    normal_across = choose(past_end, best.across / far, normal_across);
    normal_along = choose(past_end, best.beyond / far, normal_along);
  }
  Match<L> match{distance, with_sign(choose(is_x, normal_along, normal_across), x),
                 with_sign(choose(is_x, normal_across, normal_along), y)};
  if (lines.circle_radius > 0.0F) {
    const F from_centre = root(x * x + y * y);
    const F outside = from_centre - lines.circle_radius;
    const auto tangent = magnitude(x * dy - y * dx) >= magnitude(x * dx + y * dy);
    const auto closer = (outside * outside < best.square) & tangent & (from_centre > 0.0F);
    if (any(closer)) {
      const F length = choose(closer, from_centre, all<L>(1.0F));
      match.distance = choose(closer, outside, match.distance);
      match.normal_x = choose(closer, x / length, match.normal_x);
      match.normal_y = choose(closer, y / length, match.normal_y);
    }
  }
  return match;
}

/// Of each lane the sums of RefineSums, in its order.
template <class L>
struct LaneSums {
  typename L::F sum[refine_sums];
};

/// Samples i to i + lanes.
template <class L>
[[gnu::always_inline]] inline void add_samples(const RefineTerms& t, int i, LaneSums<L>& sums) {
  using F = typename L::F;
  const LineSampleView& v = t.samples;
  const auto valid = lanes_before<L>(i, v.count);
  const F weight = choose(valid, load<L>(v.weight + i), all<L>(0.0F));
  // From the camera to the point, in the attitude as given: a ray of any length.
  const Vector3<L> ray{load<L>(v.ground_x + i) - t.camera.x, load<L>(v.ground_y + i) - t.camera.y,
                       all<L>(-t.camera.height)};
  const Vector3<L> by_pitch = cross_axis<L>(t.pitch_axis, ray);
  const Vector3<L> by_roll = cross_axis<L>(t.roll_axis, ray);
  const F rx = ray.x + t.pitch * by_pitch.x + t.roll * by_roll.x;
  const F ry = ray.y + t.pitch * by_pitch.y + t.roll * by_roll.y;
  const F tilted_z = ray.z + t.pitch * by_pitch.z + t.roll * by_roll.z;
  // Within about a degree of the horizon a point says nothing.
  const F length2 = ray.x * ray.x + ray.y * ray.y + ray.z * ray.z;
  const auto below = valid & (tilted_z < 0.0F) & (tilted_z * tilted_z >= 4e-4F * length2);
  const F rz = choose(below, tilted_z, all<L>(-1.0F));
  const F reach = -t.camera.height / rz;
  const F gx = t.camera.x + reach * rx;
  const F gy = t.camera.y + reach * ry;
  const F way_x = t.cos * gx - t.sin * gy;  // from the robot, in the field's axes
  const F way_y = t.sin * gx + t.cos * gy;
  const F dir_x = load<L>(v.dir_x + i);
  const F dir_y = load<L>(v.dir_y + i);
  const Match<L> line = nearest_of<L>(t.lines, t.pose.x + way_x, t.pose.y + way_y, t.cos * dir_x - t.sin * dir_y,
                                      t.sin * dir_x + t.cos * dir_y);
  const F information = 1.0F / (load<L>(v.own_variance + i) + t.extra_variance);
  const F z2 = line.distance * line.distance * information;
  const auto near = below & (z2 < 16.0F);  // four sigma: what is farther is no point of this line
  const F saturated = 1.0F / (1.0F + z2 * (0.5F / robust_limit));
  const F pull = choose(near, saturated * saturated, all<L>(0.0F));
  sums.sum[20] += weight * choose(near, 0.5F * z2 * saturated, all<L>(robust_limit));
  sums.sum[21] += weight * pull;
  sums.sum[22] += weight;
  if (!any(near)) return;
  const F w = weight * pull * choose(near, information, all<L>(0.0F));  // infinite behind the last sample
  const F nx = line.normal_x;
  const F ny = line.normal_y;
  const F robot_nx = t.cos * nx + t.sin * ny;  // the normal in the robot's frame
  const F robot_ny = t.cos * ny - t.sin * nx;
  const F k = reach / rz;
  const F on_ray = robot_nx * rx + robot_ny * ry;
  const F j[refine_unknowns] = {nx, ny, ny * way_x - nx * way_y,
                                k * ((robot_nx * by_pitch.x + robot_ny * by_pitch.y) * rz - on_ray * by_pitch.z),
                                k * ((robot_nx * by_roll.x + robot_ny * by_roll.y) * rz - on_ray * by_roll.z)};
  int at = 0;
  for (int a = 0; a < refine_unknowns; ++a) {
    const F wj = w * j[a];
    for (int b = 0; b <= a; ++b) sums.sum[at++] += wj * j[b];
    sums.sum[15 + a] += wj * line.distance;
  }
}

template <class L>
void linearise(const RefineTerms& terms, RefineSums& out) {
  alignas(32) float lanes[refine_sums][sample_lanes];
  for (int lane = 0; lane < sample_lanes; lane += L::lanes) {
    LaneSums<L> sums;
    for (auto& sum : sums.sum) sum = all<L>(0.0F);
    for (int i = lane; i < terms.samples.count; i += sample_lanes) add_samples<L>(terms, i, sums);
    for (int k = 0; k < refine_sums; ++k) store(lanes[k] + lane, sums.sum[k]);
  }
  float total[refine_sums];
  for (int k = 0; k < refine_sums; ++k) {
    const float* l = lanes[k];
    total[k] = ((l[0] + l[4]) + (l[2] + l[6])) + ((l[1] + l[5]) + (l[3] + l[7]));
  }
  for (int k = 0; k < 15; ++k) out.hessian[k] = total[k];
  for (int k = 0; k < refine_unknowns; ++k) out.gradient[k] = total[15 + k];
  out.cost = total[20];
  out.explained = total[21];
  out.weight = total[22];
}

}  // namespace
}  // namespace touchline
