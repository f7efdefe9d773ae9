// SPDX-License-Identifier: Apache-2.0
#include "vision/circle_fit.h"

#include "vision/field_sight.h"

namespace touchline {
namespace {

constexpr int refinements = 6;
constexpr float skeleton_px = 0.8F;  // 1 sigma of a skeleton point
constexpr float rag_widths = 0.15F;  // and what the ragged edge of a wide line adds
constexpr float slack_radii = 0.2F;  // a refinement seldom moves a centre farther
constexpr float sigma_tilt = radians(0.5F);

}  // namespace

CircleFit::CircleFit(std::span<const ChainPoint> points, const WorkRays& rays, float radius_m, float line_width_m)
    : points_(points), rays_(rays), radius_m_(radius_m), line_width_m_(line_width_m) {
  constexpr float slack = 1.01F;  // sigma() adds a little so as not to divide by zero
  const float height = rays_.projection().pose().height;
  towards2_ = slack * math::square(rays_.radians_per_pixel() * skeleton_px / height);
  tilt2_ = slack * math::square(sigma_tilt * radius_m_ / height);
  rag2_ = slack * math::square(rag_widths * line_width_m_);
}

float CircleFit::sigma(const GroundPoint& p, const GroundPoint& centre) const {
  return sigma(p, centre, ground_distance(p, centre));
}

/// `apart` is the distance between both.
float CircleFit::sigma(const GroundPoint& p, const GroundPoint& centre, float apart) const {
  const CameraPose& pose = rays_.projection().pose();
  const float x = p.x - pose.x;
  const float y = p.y - pose.y;
  const float range = math::hypot(x, y) + 1.0e-6F;
  const float depth = math::hypot(range, pose.height);
  const float across = depth * rays_.radians_per_pixel() * skeleton_px;
  const float towards = across * depth / pose.height;
  const float radius = apart + 1.0e-6F;
  const float c = (x * (p.x - centre.x) + y * (p.y - centre.y)) / (range * radius);
  return math::sqrt(math::square(towards * c) + math::square(across) * (1.0F - c * c) +
                    math::square(rag_widths * line_width_m_) +
                    math::square(sigma_tilt * range * radius_m_ / pose.height));
}

bool CircleFit::near_circle(const GroundPoint& p, const GroundPoint& centre, float sigmas, float& off,
                            float& sigma_m) const {
  // Most points are far from the circle: a square tells before a root does. Its bounds are a little wider.
  const float squared = math::square(p.x - centre.x) + math::square(p.y - centre.y);
  if (squared > math::square(1.41F * radius_m_) || squared < math::square(0.59F * radius_m_)) {
    return false;
  }
  const float apart = math::sqrt(squared);
  off = apart - radius_m_;
  if (math::abs(off) > circle_band_radii * radius_m_) return false;
  // A bound of sigma squared, seen along the ray, takes neither a root nor a division.
  const CameraPose& pose = rays_.projection().pose();
  const float range2 = math::square(p.x - pose.x) + math::square(p.y - pose.y);
  const float most = towards2_ * math::square(range2 + pose.height * pose.height) + tilt2_ * range2 + rag2_;
  if (off * off > sigmas * sigmas * most) return false;
  sigma_m = sigma(p, centre, apart);
  return math::abs(off) < sigmas * sigma_m;
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

/// Gauss-Newton on the centre; the radius is known.
bool CircleFit::refine(GroundPoint& centre, Sym2& information, float& chi) const {
  Near near;
  gather(centre, near);
  for (int n = 0; n < refinements; ++n) {
    const GroundPoint before = centre;
    if (ground_distance(centre, near.centre) > 0.9F * slack_radii * radius_m_) gather(centre, near);
    information = {};
    float bx = 0.0F, by = 0.0F, sum = 0.0F, weights = 0.0F;
    for (const std::uint16_t i : near.points) {
      const ChainPoint& p = points_[i];
      float off = 0.0F, sigma_m = 1.0F;
      if (!near_circle(p.ground, centre, circle_gate, off, sigma_m)) continue;
      const float d = off + radius_m_;
      const float ux = (p.ground.x - centre.x) / d;
      const float uy = (p.ground.y - centre.y) / d;
      const float w = 1.0F / (sigma_m * sigma_m);
      information.xx += w * ux * ux;
      information.xy += w * ux * uy;
      information.yy += w * uy * uy;
      bx += w * ux * off;
      by += w * uy * off;
      sum += w * off * off;
      weights += 1.0F;
    }
    const float det = information.xx * information.yy - information.xy * information.xy;
    if (weights < 8.0F || !(det > 1.0e-4F * math::square(information.xx + information.yy))) return false;
    centre.x += (bx * information.yy - by * information.xy) / det;
    centre.y += (by * information.xx - bx * information.xy) / det;
    chi = math::sqrt(sum / weights);
    if (centre.x == before.x && centre.y == before.y) break;  // the next step would say the same
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
