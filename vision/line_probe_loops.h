// SPDX-License-Identifier: Apache-2.0
// The steps of line_probe.h, one lane at a time or many. Included by files of kernels alone, and compiled there for
// that file's processor: everything is local to the file.
#pragma once

#include "platform/core/angle_loops.h"
#include "platform/core/lanes_loops.h"
#include "vision/line_probe.h"

namespace touchline {
namespace {
namespace probe {

// --- Direction -------------------------------------------------------------------------------------------------------

/// Eigenvector of the covariance, in any unit of length.
template <class L>
[[gnu::always_inline]] inline void axis(const ProbeMoments& m, int least, float most_across, LineProbes& p, int lane) {
  using F = typename L::F;
  using I = typename L::I;
  const I state = load<L>(p.state + lane);
  const I n = load<L>(m.n + lane);
  const I x = load<L>(m.x + lane);
  const I y = load<L>(m.y + lane);
  const auto asked = (state == probe_no_direction) & (n >= least);
  if (!any(asked)) return;
  const F xx = as_float(n * load<L>(m.xx + lane) - x * x);
  const F xy = as_float(n * load<L>(m.xy + lane) - x * y);
  const F yy = as_float(n * load<L>(m.yy + lane) - y * y);
  // Eigenvalues: mean +- spread.
  const F mean = 0.5F * (xx + yy);
  const F half_difference = 0.5F * (xx - yy);
  const F spread = root(half_difference * half_difference + xy * xy);
  const auto lies = half_difference >= 0.0F;
  const F u = choose(lies, half_difference + spread, xy);
  const F v = choose(lies, xy, spread - half_difference);
  const F length = root(u * u + v * v);
  const auto found = asked & (mean - spread <= most_across * (mean + spread)) & (length > 0.0F);
  const F scale = 1.0F / choose(found, length, all<L>(1.0F));
  store(p.tangent_u + lane, choose(found, u * scale, load<L>(p.tangent_u + lane)));
  store(p.tangent_v + lane, choose(found, v * scale, load<L>(p.tangent_v + lane)));
  store(p.state + lane, choose(found, whole<L>(probe_alive), state));
}

// --- Edges -----------------------------------------------------------------------------------------------------------

/// The luma and the mask along straight lines, in steps of an eighth of a pixel from a pixel's centre.
template <class L>
struct Profile {
  using F = typename L::F;
  using I = typename L::I;
  using M = typename L::M;
  const ProbePicture& picture;
  I u, v, du, dv;  // fixed point

  /// Is there a luma sample (the middle of four pixels' centres) this far away?
  [[gnu::always_inline]] M inside(I eighths) const {
    const I at_u = u + eighths * du;
    const I at_v = v + eighths * dv;
    return (at_u >= 0) & (at_v >= 0) & (at_u < (picture.width - 1) * probe_one) &
           (at_v < (picture.height - 1) * probe_one);
  }
  /// Bilinear, in 1/65536, where inside(); anything elsewhere, where one lane alone must not ask.
  [[gnu::always_inline]] I luma(I eighths) const {
    const I at_u = u + eighths * du;
    const I at_v = v + eighths * dv;
    I top, bottom;  // the left sample in the lowest byte, the right one in the next
    if constexpr (L::lanes == 1) {
      const std::uint8_t* from = picture.luma + (at_v >> 16) * picture.luma_stride + (at_u >> 16);
      top = from[0] | from[1] << 8;
      bottom = from[picture.luma_stride] | from[picture.luma_stride + 1] << 8;
    } else {  // of lanes that have no sample there, too
      const I zero = whole<L>(0);
      const I x = least(most(at_u >> 16, zero), whole<L>(picture.width - 1));
      const I y = least(most(at_v >> 16, zero), whole<L>(picture.height - 2));
      const I first = least(x, whole<L>(picture.width - 4));  // four bytes are read
      const I bit = (x - first) << 3;
      const I address = y * picture.luma_stride + first;
      top = word_at(picture.luma, address) >> bit;
      bottom = word_at(picture.luma, address + picture.luma_stride) >> bit;
    }
    const I fu = (at_u >> 8) & 255;
    const I fv = (at_v >> 8) & 255;
    const I upper = (top & 255) * 256 + fu * (((top >> 8) & 255) - (top & 255));
    const I lower = (bottom & 255) * 256 + fu * (((bottom >> 8) & 255) - (bottom & 255));
    return upper * 256 + fv * (lower - upper);
  }
  /// How far the mask reaches, in whole pixels; `sign` 1 ahead, -1 back. Negative when it does not end within reach.
  [[gnu::always_inline]] I mask_reach(M alive, int sign) const {
    const I step_u = du * (8 * sign);
    const I step_v = dv * (8 * sign);
    I at_u = u + probe_one / 2;  // from the pixel's corner
    I at_v = v + probe_one / 2;
    I reach = whole<L>(-1);
    M open = alive;
    for (int k = 1; k <= picture.half_width && any(open); ++k) {
      at_u += step_u;
      at_v += step_v;
      const I x = at_u >> 16;
      const I y = at_v >> 16;
      open = open & (x >= 0) & (y >= 0) & (x < picture.width) & (y < picture.height);
      const I address = choose(open, y * picture.mask_stride + ((x >> 5) << 2), whole<L>(0));
      const M line = ((word_at(picture.mask, address) >> (x & 31)) & 1) != 0;
      reach = choose(without(open, line), whole<L>(k), reach);
      open = open & line;
    }
    return reach;
  }
  /// Of the line: the mean of its inner half by the trapezoidal rule, or the brightest of five samples where it is
  /// thin.
  [[gnu::always_inline]] I level(I ahead, I back) const {
    const I width = ahead + back;
    const M thin = width <= 5;
    const I step = choose(thin, whole<L>(4), width);
    const I centre = choose(thin, whole<L>(0), (ahead - back) << 2);
    I sum = whole<L>(0);
    I brightest = whole<L>(0);
    for (int k = -2; k <= 2; ++k) {
      const I sample = luma(centre + step * k);
      sum += k == -2 || k == 2 ? sample : sample << 1;
      brightest = most(brightest, sample);
    }
    return choose(thin, brightest, sum >> 3);
  }
  /// Where the luma falls through the middle between the line's and the carpet's, in pixels ahead or back; returns
  /// where it does.
  [[gnu::always_inline]] M find_edge(M alive, int sign, I reach, I line_level, F& edge) const {
    constexpr int step = 4;  // half a pixel
    const I end = (reach + probe_side_px) << 3;
    const I outermost = luma(end * sign);
    const I next = luma((end - step) * sign);
    const I third = luma((end - 2 * step) * sign);
    const I carpet = least(least(outermost, next), third);
    M open = alive & (line_level > carpet + 2 * probe_one);
    const I middle = (line_level + carpet) >> 1;
    // Inward from the carpet, so that a hole in a worn line does no harm.
    I outer = carpet;
    M found = without(open, open);
    for (int k = 1; k <= 2 * (picture.half_width + probe_side_px) && any(open); ++k) {
      const I at = end - k * step;
      open = open & (at >= 0);
      const I inner = k == 1 ? next : k == 2 ? third : luma(at * sign);
      const M here = open & (inner >= middle);
      const F share = as_float(middle - outer) / as_float(choose(here, inner - outer, whole<L>(1)));
      edge = choose(here, 0.125F * as_float(at + step) - 0.5F * share, edge);
      found = found | here;
      open = without(open, here);
      outer = inner;
    }
    return found;
  }
};

/// Of a part of a unit vector, in an eighth of a pixel.
template <class F>
[[gnu::always_inline]] inline auto fixed(F part) {
  const F scaled = part * (static_cast<float>(probe_one) / 8.0F);
  return truncated(scaled + with_sign(F{} + 0.5F, scaled));
}

template <class L>
[[gnu::always_inline]] inline void edge_pair(const ProbePicture& picture, LineProbes& p, int lane) {
  using F = typename L::F;
  using I = typename L::I;
  using M = typename L::M;
  const I state = load<L>(p.state + lane);
  const M alive = state == probe_alive;
  if (!any(alive)) return;
  const Profile<L> profile{picture, load<L>(p.x + lane) * probe_one, load<L>(p.y + lane) * probe_one,
                           fixed(-load<L>(p.tangent_v + lane)), fixed(load<L>(p.tangent_u + lane))};
  const I reach_a = profile.mask_reach(alive, 1);
  const I reach_b = profile.mask_reach(alive, -1);
  M good = alive & (reach_a >= 0) & (reach_b >= 0);
  // The other samples lie between these.
  const M inside_a = profile.inside((reach_a + probe_side_px) << 3);
  const M inside_b = profile.inside((reach_b + probe_side_px) * -8);
  good = good & inside_a & inside_b;
  if (any(good)) {
    const I level = profile.level(reach_a, reach_b);
    F ahead = all<L>(0.0F);
    F back = all<L>(0.0F);
    good = profile.find_edge(good, 1, reach_a, level, ahead);
    good = profile.find_edge(good, -1, reach_b, level, back);
    store(p.ahead + lane, ahead);
    store(p.back + lane, back);
  }
  store(p.state + lane, choose(without(alive, good), whole<L>(probe_no_edge), state));
}

// --- Width on the ground ---------------------------------------------------------------------------------------------

template <class L>
struct Vector {
  typename L::F x, y, z;
};
template <class L>
[[gnu::always_inline]] inline Vector<L> turned(const Mat3& a, const Vector<L>& v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
template <class L>
[[gnu::always_inline]] inline Vector<L> mixed(const Vector<L>& a, const Vector<L>& b, typename L::F share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}
template <class L>
[[gnu::always_inline]] inline Vector<L> slope(const Vector<L>& a, const Vector<L>& b) {
  constexpr float cells_a_px = 0.125F;
  return {cells_a_px * (b.x - a.x), cells_a_px * (b.y - a.y), cells_a_px * (b.z - a.z)};
}
template <class L>
[[gnu::always_inline]] inline Vector<L> corner(const float* rays, typename L::I at) {
  return {float_at(rays, at), float_at(rays, at + 1), float_at(rays, at + 2)};
}
/// The lens has a ray there.
template <class L>
[[gnu::always_inline]] inline typename L::M seen(const Vector<L>& ray) {
  return ray.x * ray.x + ray.y * ray.y + ray.z * ray.z >= 0.5F;
}

/// A ray and how it turns per working pixel: that of the ray grid, interpolated.
template <class L>
struct Patch {
  Vector<L> ray, by_u, by_v;
};
template <class L>
[[gnu::always_inline]] inline typename L::M find_patch(const ProbeView& view, typename L::F at_u, typename L::F at_v,
                                                       Patch<L>& patch) {
  using F = typename L::F;
  using I = typename L::I;
  const F u = at_u * 0.125F;
  const F v = at_v * 0.125F;
  const auto above =
      (u >= 0.0F) & (v >= 0.0F) & (u < static_cast<float>(view.columns)) & (v < static_cast<float>(view.rows));
  const I column = truncated(choose(above, u, all<L>(0.0F)));
  const I row = truncated(choose(above, v, all<L>(0.0F)));
  const auto inside = above & (column + 1 < view.columns) & (row + 1 < view.rows);
  const I at = choose(inside, (row * view.columns + column) * 3, whole<L>(0));
  const Vector<L> a = corner<L>(view.rays, at);
  const Vector<L> b = corner<L>(view.rays, at + 3);
  const Vector<L> c = corner<L>(view.rays, at + 3 * view.columns);
  const Vector<L> d = corner<L>(view.rays, at + 3 * view.columns + 3);
  const F across = u - as_float(column);
  const F down = v - as_float(row);
  const Vector<L> upper = mixed<L>(a, b, across);
  const Vector<L> lower = mixed<L>(c, d, across);
  patch.ray = turned<L>(view.robot_from_camera, mixed<L>(upper, lower, down));
  patch.by_u = turned<L>(view.robot_from_camera, slope<L>(mixed<L>(a, c, down), mixed<L>(b, d, down)));
  patch.by_v = turned<L>(view.robot_from_camera, slope<L>(upper, lower));
  return inside & seen<L>(a) & seen<L>(b) & seen<L>(c) & seen<L>(d);
}

template <class L>
struct GroundStep {
  typename L::F x, y;
};
/// How far the ground point moves per pixel along (u, v): the derivative of height * ray.xy / -ray.z.
template <class L>
[[gnu::always_inline]] inline GroundStep<L> ground_step(const Patch<L>& at, typename L::F u, typename L::F v,
                                                        typename L::F inverse_z, typename L::F reach) {
  using F = typename L::F;
  const F share = (u * at.by_u.z + v * at.by_v.z) * inverse_z;
  return {reach * ((u * at.by_u.x + v * at.by_v.x) - at.ray.x * share),
          reach * ((u * at.by_u.y + v * at.by_v.y) - at.ray.y * share)};
}

/// Blur makes a line up to about a pixel wider than it is, wear makes it thinner.
template <class F>
[[gnu::always_inline]] inline auto right_width(F measured_px, F expected_px) {
  return (measured_px < 1.35F * expected_px + 1.5F) & (measured_px > 0.55F * expected_px - 0.5F);
}

template <class L>
[[gnu::always_inline]] inline void width(const ProbeView& view, LineProbes& p, int lane) {
  using F = typename L::F;
  using I = typename L::I;
  using M = typename L::M;
  const I state = load<L>(p.state + lane);
  const M alive = state == probe_alive;
  if (!any(alive)) return;
  const F zero = all<L>(0.0F);
  const F tangent_u = load<L>(p.tangent_u + lane);
  const F tangent_v = load<L>(p.tangent_v + lane);
  const F ahead = load<L>(p.ahead + lane);
  const F back = load<L>(p.back + lane);
  const F middle = 0.5F * (ahead - back);
  const F u = as_float(load<L>(p.x + lane)) + 0.5F - middle * tangent_v;
  const F v = as_float(load<L>(p.y + lane)) + 0.5F + middle * tangent_u;
  Patch<L> patch;
  M ground = alive & find_patch<L>(view, u, v, patch);
  ground = ground & (patch.ray.z < -probe_descent);
  const F inverse_z = 1.0F / choose(ground, patch.ray.z, all<L>(-1.0F));
  const F reach = -view.height * inverse_z;
  const GroundStep<L> run = ground_step<L>(patch, tangent_u, tangent_v, inverse_z, reach);
  const GroundStep<L> step = ground_step<L>(patch, -tangent_v, tangent_u, inverse_z, reach);
  const F length = root(run.x * run.x + run.y * run.y);
  ground = ground & (length > 0.0F);
  const F inverse_length = 1.0F / choose(ground, length, all<L>(1.0F));
  const F across = magnitude(step.x * run.y - step.y * run.x) * inverse_length;
  ground = ground & (across > 0.0F);
  const F expected = view.line_width_m / choose(ground, across, all<L>(1.0F));
  const F measured = ahead + back;
  const M good = ground & right_width(measured, expected);
  // A thin line's blur is wider than itself.
  const F half = choose(expected < 3.0F, all<L>(0.5F), 0.5F * measured);
  const F sign = choose((run.x > 0.0F) | ((run.x == 0.0F) & (run.y > 0.0F)), inverse_length, -inverse_length);
  store(p.middle_u + lane, u);
  store(p.middle_v + lane, v);
  store(p.half + lane, half);
  store(p.dir_x + lane, run.x * sign);
  store(p.dir_y + lane, run.y * sign);
  store(p.length + lane, length);
  store(p.across + lane, across);
  for (int side = 0; side < 2; ++side) {
    const F off = side == 0 ? half : -half;
    const F edge_u = (u - off * tangent_v) * view.per_work_u - view.cx;
    const F edge_v = (v + off * tangent_u) * view.per_work_v - view.cy;
    store(p.edge_u[side] + lane, edge_u);
    store(p.edge_v[side] + lane, edge_v);
    store(p.radius[side] + lane, choose(good, root(edge_u * edge_u + edge_v * edge_v), zero));
  }
  const I wrong = choose(ground, whole<L>(probe_wrong_width), whole<L>(probe_no_ground));
  store(p.state + lane, choose(without(alive, good), wrong, state));
}

// --- Place on the ground ---------------------------------------------------------------------------------------------

/// The ground under the line's edges; the middle of both, and its place in the picture.
template <class L>
[[gnu::always_inline]] inline void place(const ProbeView& view, LineProbes& p, int lane) {
  using F = typename L::F;
  using I = typename L::I;
  using M = typename L::M;
  const I state = load<L>(p.state + lane);
  const M alive = state == probe_alive;
  if (!any(alive)) return;
  M good = alive;
  F x[2], y[2], far[2];
  for (int side = 0; side < 2; ++side) {
    const F radius = load<L>(p.radius[side] + lane);
    const SineCosine<L> of_theta = sine_cosine_of<L>(load<L>(p.theta[side] + lane));
    const F scale = choose(radius > 0.0F, of_theta.sin, all<L>(0.0F)) / choose(radius > 0.0F, radius, all<L>(1.0F));
    const Vector<L> ray = turned<L>(view.robot_from_camera, {load<L>(p.edge_u[side] + lane) * scale,
                                                             load<L>(p.edge_v[side] + lane) * scale, of_theta.cos});
    good = good & (radius <= view.max_radius) & (ray.z < -probe_descent);
    const F reach = -view.height / choose(good, ray.z, all<L>(-1.0F));
    x[side] = reach * ray.x;
    y[side] = reach * ray.y;
    far[side] = root(x[side] * x[side] + y[side] * y[side] + view.height * view.height);
  }
  const F middle_x = 0.5F * (x[0] + x[1]);
  const F middle_y = 0.5F * (y[0] + y[1]);
  good = good & (middle_x * middle_x + middle_y * middle_y <= view.max_range_m * view.max_range_m);
  store(p.ground_x + lane, view.x + middle_x);
  store(p.ground_y + lane, view.y + middle_y);
  // Each edge counts in the picture by its distance from the camera.
  store(p.off_middle + lane, load<L>(p.half + lane) * (far[0] - far[1]) / (far[0] + far[1]));
  store(p.state + lane, choose(without(alive, good), whole<L>(probe_no_ground), state));
}

template <class L>
void axes(const ProbeMoments& moments, int least, float most_across, LineProbes& probes) {
  for (int lane = 0; lane < probes.count; lane += L::lanes) axis<L>(moments, least, most_across, probes, lane);
}
template <class L>
void edges(const ProbePicture& picture, LineProbes& probes) {
  for (int lane = 0; lane < probes.count; lane += L::lanes) edge_pair<L>(picture, probes, lane);
}
template <class L>
void widths(const ProbeView& view, LineProbes& probes) {
  for (int lane = 0; lane < probes.count; lane += L::lanes) width<L>(view, probes, lane);
}
template <class L>
void places(const ProbeView& view, LineProbes& probes) {
  for (int lane = 0; lane < probes.count; lane += L::lanes) place<L>(view, probes, lane);
}

template <class L>
constexpr ProbeKernels kernels(void (*moments)(const ProbeWindows&, ProbeMoments&) = nullptr) {
  return {moments, axes<L>, edges<L>, widths<L>, places<L>};
}

}  // namespace probe
}  // namespace
}  // namespace touchline
