// SPDX-License-Identifier: Apache-2.0
// Dispatches to the model's file and checks what was asked for. The check walks the model in small steps, because a
// model that is not monotonic has two rays for one pixel.
#include "vision/lens/lens.h"

#include "platform/core/atan2_lanes.h"
#include "platform/core/elementary.h"
#include "vision/lens/barrel.h"
#include "vision/lens/equidistant.h"
#include "vision/lens/equisolid.h"
#include "vision/lens/kannala_brandt.h"
#include "vision/lens/polynomial.h"
#include "vision/lens/rectilinear.h"

namespace touchline {
namespace {

constexpr float max_pinhole_theta = radians(89.9F);  // r = f tan(theta) has no end at 90 degrees
constexpr float max_parameter = 1.0e5F;              // px; far beyond any camera, and far from overflow
constexpr int max_image_radius = 2048;               // px; the diagonal of a 1280x1024 image is 1640

bool through_pinhole(LensModel model) {
  return model == LensModel::rectilinear || model == LensModel::barrel || model == LensModel::polynomial;
}

template <std::size_t N>
bool all_finite(const std::array<float, N>& values) {
  for (const float v : values) {
    if (!math::is_finite(v)) return false;
  }
  return true;
}

bool is_identity(const std::array<float, 8>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (b[i] != (i == 1 ? 1.0F : 0.0F)) return false;
  }
  return true;
}

float model_theta(const LensParameters& lens, float radius) {
  switch (lens.model) {
    case LensModel::equidistant: return equidistant::theta_from_radius(lens, radius);
    case LensModel::equisolid: return equisolid::theta_from_radius(lens, radius);
    case LensModel::rectilinear: return rectilinear::theta_from_radius(lens, radius);
    case LensModel::kannala_brandt: return kannala_brandt::theta_from_radius(lens, radius);
    case LensModel::barrel: return barrel::theta_from_radius(lens, radius);
    case LensModel::polynomial: return polynomial::theta_from_radius(lens, radius);
  }
  return 0.0F;
}

float model_radius(const LensParameters& lens, float theta, float max_radius) {
  switch (lens.model) {
    case LensModel::equidistant: return equidistant::radius_from_theta(lens, theta);
    case LensModel::equisolid: return equisolid::radius_from_theta(lens, theta);
    case LensModel::rectilinear: return rectilinear::radius_from_theta(lens, theta);
    case LensModel::kannala_brandt: return kannala_brandt::radius_from_theta(lens, theta);
    case LensModel::barrel: return barrel::radius_from_theta(lens, theta);
    case LensModel::polynomial: return polynomial::radius_from_theta(lens, theta, max_radius);
  }
  return 0.0F;
}

/// What is wrong with the numbers themselves; null when nothing is.
const char* check_ranges(const LensParameters& p) {
  if (!(p.focal_px > 0.0F && p.focal_px <= max_parameter)) return "focal_px must be a number above 0, in pixels";
  if (!(math::abs(p.cx) <= max_parameter)) return "cx must be a number, in pixels";
  if (!(math::abs(p.cy) <= max_parameter)) return "cy must be a number, in pixels";
  if (!(p.max_theta > 0.0F && p.max_theta <= math::pi)) return "max_theta_deg must be above 0 and at most 180";
  if (!all_finite(p.k)) return "k1..k4 must be numbers";
  if (!math::is_finite(p.alpha)) return "alpha must be a number, in 1/px^2";
  if (!all_finite(p.a)) return "a must hold numbers";
  if (!all_finite(p.b)) return "b must hold numbers";
  return nullptr;
}

const char* check_kannala_brandt(const LensParameters& p) {
  for (int i = 0; i <= 512; ++i) {
    if (!(kannala_brandt::radius_slope(p, p.max_theta * static_cast<float>(i) / 512.0F) > 0.0F)) {
      return "k1..k4 make the radius shrink before max_theta_deg; lower max_theta_deg or calibrate anew";
    }
  }
  return nullptr;
}

const char* check_barrel(const LensParameters& p) {
  const float corrected = p.focal_px * math::tan(p.max_theta);
  if (1.0F + 4.0F * p.alpha * corrected * corrected > 0.0F) return nullptr;
  return "a negative alpha folds the image before max_theta_deg; lower max_theta_deg";
}

/// Walks outward until max_theta; `max_radius` is where it was reached.
const char* check_polynomial_radius(const LensParameters& p, float& max_radius) {
  if (!(math::abs(p.a[0]) <= 1.0F)) return "a[0] must be within one pixel of 0: the centre sees along the axis";
  const float target = p.focal_px * math::tan(p.max_theta);
  for (int i = 0; i < 2 * max_image_radius; ++i) {
    const float r = 0.5F * static_cast<float>(i);
    const float next = r + 0.5F;
    if (!(polynomial::slope(p.a, r) > 0.0F) || !(polynomial::evaluate(p.a, next) > polynomial::evaluate(p.a, r))) {
      return "a makes r_c shrink before max_theta_deg; lower max_theta_deg or fit a anew";
    }
    if (polynomial::evaluate(p.a, next) >= target) {
      max_radius = invert_increasing([&p](float x) { return polynomial::evaluate(p.a, x); },
                                     [&p](float x) { return polynomial::slope(p.a, x); }, target, r, next, next);
      return nullptr;
    }
  }
  return "a does not reach max_theta_deg within 2048 pixels; lower max_theta_deg";
}

const char* check_polynomial_angle(const LensParameters& p) {
  if (is_identity(p.b)) return nullptr;
  for (int i = -256; i <= 256; ++i) {
    if (!(polynomial::slope(p.b, math::pi * static_cast<float>(i) / 256.0F) > 0.0F)) {
      return "b must make the polar angle grow over the whole turn";
    }
  }
  const float turn = polynomial::evaluate(p.b, math::pi) - polynomial::evaluate(p.b, -math::pi);
  if (!(math::abs(turn - math::two_pi) <= radians(1.0F)))
    return "b must map a whole turn to a whole turn, within 1 degree";
  if (!(math::abs(p.b[0]) <= 0.5F * math::pi)) return "b[0] must be within a quarter turn of 0";
  return nullptr;
}

/// model_radius() of the angles of some rays; those that are not seen have none.
void model_radii(const LensParameters& lens, float max_radius, const RayLanes& rays, const float* theta,
                 float* radius) {
  const int count = rays.padded();
  switch (lens.model) {
    case LensModel::equidistant:
      for (int i = 0; i < count; ++i) radius[i] = equidistant::radius_from_theta(lens, theta[i]);
      return;
    case LensModel::kannala_brandt:
      for (int i = 0; i < count; ++i) radius[i] = kannala_brandt::radius_from_theta(lens, theta[i]);
      return;
    default:
      for (int i = 0; i < count; ++i) {
        radius[i] = rays.seen[i] != 0 ? model_radius(lens, theta[i], max_radius) : 0.0F;
      }
  }
}

}  // namespace

Status Lens::create(const LensParameters& parameters, Lens& out, const char** what) {
  Lens lens;
  lens.parameters_ = parameters;
  LensParameters& p = lens.parameters_;
  const char* wrong = check_ranges(p);
  if (wrong == nullptr && through_pinhole(p.model)) p.max_theta = math::min(p.max_theta, max_pinhole_theta);
  if (wrong == nullptr && p.model == LensModel::kannala_brandt) wrong = check_kannala_brandt(p);
  if (wrong == nullptr && p.model == LensModel::barrel) wrong = check_barrel(p);
  if (wrong == nullptr && p.model == LensModel::polynomial) wrong = check_polynomial_radius(p, lens.max_radius_);
  if (wrong == nullptr && p.model == LensModel::polynomial) wrong = check_polynomial_angle(p);
  if (wrong != nullptr) {
    if (what != nullptr) *what = wrong;
    return Status::invalid_argument;
  }
  if (p.model != LensModel::polynomial) lens.max_radius_ = model_radius(p, p.max_theta, 0.0F);
  lens.bends_angle_ = p.model == LensModel::polynomial && !is_identity(p.b);
  out = lens;
  return Status::ok;
}

bool Lens::ray(const PixelPoint& pixel, Vec3& ray) const {
  float dx = pixel.u - parameters_.cx;
  float dy = pixel.v - parameters_.cy;
  const float radius = math::hypot(dx, dy);
  if (!(radius <= max_radius_) || max_radius_ <= 0.0F) return false;
  if (bends_angle_) {
    const auto [s, c] = math::sin_cos(polynomial::corrected_angle(parameters_, math::atan2(dy, dx)));
    dx = radius * c;
    dy = radius * s;
  }
  const auto [s, c] = math::sin_cos(model_theta(parameters_, radius));
  const float scale = radius > 0.0F ? s / radius : 0.0F;
  ray = {dx * scale, dy * scale, c};
  return true;
}

void Lens::angles(int count, const float* radius, float* u, float* v, float* theta) const {
  if (parameters_.model == LensModel::equidistant) {  // a plain loop becomes vectors
    for (int i = 0; i < count; ++i) {
      theta[i] = equidistant::theta_from_radius(parameters_, math::min(radius[i], max_radius_));
    }
    return;
  }
  for (int i = 0; i < count; ++i) {
    theta[i] = model_theta(parameters_, math::min(radius[i], max_radius_));
    if (!bends_angle_) continue;
    const auto [s, c] = math::sin_cos(polynomial::corrected_angle(parameters_, math::atan2(v[i], u[i])));
    u[i] = radius[i] * c;
    v[i] = radius[i] * s;
  }
}

bool Lens::pixel(const Vec3& ray, PixelPoint& pixel) const {
  const float across = math::hypot(ray.x, ray.y);
  if (across == 0.0F && ray.z == 0.0F) return false;
  const float theta = math::atan2(across, ray.z);
  if (!(theta <= parameters_.max_theta) || max_radius_ <= 0.0F) return false;
  // Rounding must not carry a ray at the edge past it: ray(pixel) would not find it.
  const float radius = math::min(model_radius(parameters_, theta, max_radius_), max_radius_);
  float dx = ray.x;
  float dy = ray.y;
  float scale = across > 0.0F ? radius / across : 0.0F;
  if (bends_angle_) {
    const auto [s, c] = math::sin_cos(polynomial::distorted_angle(parameters_, math::atan2(dy, dx)));
    dx = c;
    dy = s;
    scale = radius;
  }
  pixel = {parameters_.cx + dx * scale, parameters_.cy + dy * scale};
  return true;
}

void Lens::pixels(RayLanes& rays) const {
  if (bends_angle_ || max_radius_ <= 0.0F) {
    for (int i = 0; i < rays.count; ++i) {
      PixelPoint p;
      rays.seen[i] = pixel({rays.x[i], rays.y[i], rays.z[i]}, p) ? 1 : 0;
      rays.u[i] = p.u;
      rays.v[i] = p.v;
    }
    return;
  }
  rays.pad();
  const int count = rays.padded();
  const LensParameters lens = parameters_;  // of our own, so that no store to the lanes can change it
  const float max_radius = max_radius_;
  float across[RayLanes::most], theta[RayLanes::most], radius[RayLanes::most];
  for (int i = 0; i < count; ++i) across[i] = math::hypot(rays.x[i], rays.y[i]);
  for (int i = 0; i < count; ++i) theta[i] = math::atan2_lane(across[i], rays.z[i]);
  for (int i = 0; i < count; ++i) {
    const int inside = theta[i] <= lens.max_theta ? 1 : 0;
    const int somewhere = across[i] + math::abs(rays.z[i]) > 0.0F ? 1 : 0;
    rays.seen[i] = inside & somewhere;
  }
  model_radii(lens, max_radius, rays, theta, radius);
  for (int i = 0; i < count; ++i) {
    constexpr float tiny = 1.0e-30F;  // below every root but 0, whose ray ends at the centre by any scale
    const float scale = math::min(radius[i], max_radius) / math::max(across[i], tiny);
    rays.u[i] = lens.cx + rays.x[i] * scale;
    rays.v[i] = lens.cy + rays.y[i] * scale;
  }
}

}  // namespace touchline
