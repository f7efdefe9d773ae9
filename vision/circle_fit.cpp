// SPDX-License-Identifier: Apache-2.0
#include "vision/circle_fit.h"

#include "vision/field_sight.h"

namespace touchline {
namespace {

constexpr int refinements = 6;
// A step this short says nothing: a working pixel is twenty times as long and more.
constexpr float settled_m = 1.0e-4F;
constexpr float skeleton_px = 0.8F;  // 1 sigma of a skeleton point
constexpr float rag_widths = 0.15F;  // and what the ragged edge of a wide line adds
constexpr float slack_radii = 0.2F;  // a refinement seldom moves a centre farther
constexpr float sigma_tilt = radians(0.5F);

}  // namespace

CircleFit::CircleFit(std::span<const ChainPoint> points, const WorkRays& rays, float radius_m, float line_width_m)
    : points_(points),
      rays_(rays),
      radius_m_(radius_m),
      line_width_m_(line_width_m),
      band_inner2_(math::square((0.99F - circle_band_radii) * radius_m)),
      band_outer2_(math::square((1.01F + circle_band_radii) * radius_m)) {}

float CircleFit::sigma(const GroundPoint& p, const GroundPoint& centre) const {
  RimPoints rim;
  rim.count = 1;
  rim.x[0] = p.x;
  rim.y[0] = p.y;
  measure(centre, rim);
  return rim.sigma[0];
}

void CircleFit::measure(const GroundPoint& centre, RimPoints& rim) const {
  const CameraPose& pose = rays_.projection().pose();
  const float pixel = rays_.radians_per_pixel();
  const float rag2 = math::square(rag_widths * line_width_m_);
  for (int i = 0; i < rim.count; ++i) {
    const float x = rim.x[i] - pose.x;
    const float y = rim.y[i] - pose.y;
    const float dx = rim.x[i] - centre.x;
    const float dy = rim.y[i] - centre.y;
    const float apart = math::hypot(dx, dy);
    const float range = math::hypot(x, y) + 1.0e-6F;
    const float depth = math::hypot(range, pose.height);
    const float across = depth * pixel * skeleton_px;
    const float towards = across * depth / pose.height;
    const float c = (x * dx + y * dy) / (range * (apart + 1.0e-6F));
    rim.dx[i] = dx;
    rim.dy[i] = dy;
    rim.off[i] = apart - radius_m_;
    // The sum is above zero, as `towards` is no less than `across`: a vector's root needs no look at signs.
    rim.sigma[i] = __builtin_sqrtf(math::square(towards * c) + math::square(across) * (1.0F - c * c) + rag2 +
                                   math::square(sigma_tilt * range * radius_m_ / pose.height));
  }
}

/// What near_circle() may accept until the centre has moved by the slack.
void CircleFit::gather(const GroundPoint& centre, Near& near) const {
  const float inner = math::square((1.0F - circle_band_radii - slack_radii) * radius_m_);
  const float outer = math::square((1.0F + circle_band_radii + slack_radii) * radius_m_);
  near.points.clear();
  near.centre = centre;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const GroundPoint& p = points_[i].ground;
    const float squared = math::square(p.x - centre.x) + math::square(p.y - centre.y);
    if (squared > inner && squared < outer) near.points.push_back(static_cast<std::uint16_t>(i));
  }
}

/// The points that are seen as the circle's. The others add zeros, so that nothing is branched on.
void CircleFit::add(const GroundPoint& centre, RimPoints& rim, Normals& sums) const {
  measure(centre, rim);
  float w[RimPoints::most], ux[RimPoints::most], uy[RimPoints::most], one[RimPoints::most];
  for (int i = 0; i < rim.count; ++i) {
    const float apart = rim.off[i] + radius_m_;
    one[i] = near_circle(rim.off[i], rim.sigma[i], circle_gate) ? 1.0F : 0.0F;
    w[i] = one[i] / (rim.sigma[i] * rim.sigma[i]);
    ux[i] = rim.dx[i] / apart;
    uy[i] = rim.dy[i] / apart;
  }
  for (int i = 0; i < rim.count; ++i) {
    sums.information.xx += w[i] * ux[i] * ux[i];
    sums.information.xy += w[i] * ux[i] * uy[i];
    sums.information.yy += w[i] * uy[i] * uy[i];
    sums.bx += w[i] * ux[i] * rim.off[i];
    sums.by += w[i] * uy[i] * rim.off[i];
    sums.squares += w[i] * rim.off[i] * rim.off[i];
    sums.count += one[i];
  }
  rim.count = 0;
}

/// Gauss-Newton on the centre; the radius is known.
bool CircleFit::refine(GroundPoint& centre, Sym2& information, float& chi) const {
  Near near;
  gather(centre, near);
  RimPoints rim;
  for (int n = 0; n < refinements; ++n) {
    const GroundPoint before = centre;
    if (ground_distance(centre, near.centre) > 0.9F * slack_radii * radius_m_) gather(centre, near);
    Normals sums;
    for (const std::uint16_t i : near.points) {
      const GroundPoint& p = points_[i].ground;
      rim.x[rim.count] = p.x;
      rim.y[rim.count] = p.y;
      rim.count += in_band(math::square(p.x - centre.x) + math::square(p.y - centre.y)) ? 1 : 0;
      if (rim.count == RimPoints::most) add(centre, rim, sums);
    }
    add(centre, rim, sums);
    information = sums.information;
    const float det = information.xx * information.yy - information.xy * information.xy;
    if (sums.count < 8.0F || !(det > 1.0e-4F * math::square(information.xx + information.yy))) return false;
    centre.x += (sums.bx * information.yy - sums.by * information.xy) / det;
    centre.y += (sums.by * information.xx - sums.bx * information.xy) / det;
    chi = math::sqrt(sums.squares / sums.count);
    if (ground_distance(centre, before) < settled_m) break;
  }
  return true;
}

Sym2 CircleFit::covariance(const GroundPoint& centre, const Sym2& information) const {
  const float det = information.xx * information.yy - information.xy * information.xy;
  // Skeleton points beside each other share their error: count one in four.
  Sym2 c{4.0F * information.yy / det, -4.0F * information.xy / det, 4.0F * information.xx / det};
  PixelPoint pixel;
  if (rays_.projection().pixel(centre, pixel)) {
    const Sym2 tilt = rays_.projection().ground_covariance(pixel, 0.0F, sigma_tilt);
    c.xx += tilt.xx;
    c.xy += tilt.xy;
    c.yy += tilt.yy;
  }
  return c;
}

}  // namespace touchline
