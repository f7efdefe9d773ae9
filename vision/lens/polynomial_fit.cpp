// SPDX-License-Identifier: Apache-2.0
// Normal equations in double over powers of an argument scaled to [-1, 1], so that any number of pairs needs one 8x8
// matrix and no heap. At degree 7 their condition number is about 1e10, which leaves six digits of the constants and
// more of the curve.
#include "vision/lens/polynomial_fit.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "platform/core/elementary.h"
#include "vision/lens/polynomial.h"

namespace touchline {
namespace {

constexpr int terms = 8;
using Matrix = Eigen::Matrix<double, terms, terms>;
using Vector = Eigen::Matrix<double, terms, 1>;

struct Polar {
  float radius, angle;
};

Polar polar(const PixelPoint& p, const PixelPoint& centre) {
  const float dx = p.u - centre.u;
  const float dy = p.v - centre.v;
  return {math::hypot(dx, dy), math::atan2(dy, dx)};
}

/// Weighted least squares of value = sum c_i x^i, i from first to degree.
class NormalEquations {
 public:
  NormalEquations(int first, int degree) : first_(first), degree_(degree) {}

  void add(double x, double value, double weight) {
    Vector powers = Vector::Zero();
    double power = first_ == 0 ? 1.0 : x;
    for (int i = first_; i <= degree_; ++i) {
      powers[i] = power;
      power *= x;
    }
    for (int i = 0; i < terms; ++i) {
      for (int j = 0; j < terms; ++j) matrix_(i, j) += weight * powers[i] * powers[j];
      right_[i] += weight * powers[i] * value;
    }
  }

  /// Constants for the unscaled argument, x = argument / scale. False when the pairs do not determine them.
  bool solve(double scale, std::array<float, terms>& constants) const {
    Matrix matrix = matrix_;
    // Powers that take no part get an equation of their own: c_i = 0.
    const double largest = matrix.diagonal().maxCoeff();
    for (int i = 0; i < terms; ++i) {
      if (i < first_ || i > degree_) matrix(i, i) = largest;
    }
    const Eigen::LDLT<Matrix> factors(matrix);
    const Vector pivots = factors.vectorD();
    if (!(largest > 0.0) || !(pivots.minCoeff() > 1.0e-13 * largest)) return false;
    const Vector solution = factors.solve(right_);
    double divisor = 1.0;
    for (int i = 0; i < terms; ++i) {
      constants[static_cast<std::size_t>(i)] = static_cast<float>(solution[i] / divisor);
      divisor *= scale;
    }
    return true;
  }

 private:
  int first_, degree_;
  Matrix matrix_ = Matrix::Zero();
  Vector right_ = Vector::Zero();
};

const char* check(std::span<const PointPair> pairs, const PolynomialFitSettings& settings) {
  if (settings.degree != 5 && settings.degree != 7) return "degree must be 5 or 7";
  if (!(settings.focal_px > 0.0F && settings.focal_px <= 1.0e5F)) return "focal_px must be a number above 0, in pixels";
  if (!math::is_finite(settings.principal_point.u + settings.principal_point.v))
    return "principal_point must be a number";
  for (const PointPair& pair : pairs) {
    if (!math::is_finite(pair.distorted.u + pair.distorted.v + pair.pinhole.u + pair.pinhole.v)) {
      return "pairs must hold numbers";
    }
  }
  return nullptr;
}

Vec3 pinhole_ray(float radius, float angle, float focal_px) {
  const auto [s, c] = math::sin_cos(angle);
  return normalized({radius * c, radius * s, focal_px});
}

void measure(std::span<const PointPair> pairs, const PolynomialFitSettings& settings, PolynomialFit& fit) {
  double sum = 0.0;
  for (const PointPair& pair : pairs) {
    const Polar seen = polar(pair.distorted, settings.principal_point);
    const Polar given = polar(pair.pinhole, settings.principal_point);
    const Vec3 fitted = pinhole_ray(math::max(polynomial::evaluate(fit.a, seen.radius), 0.0F),
                                    polynomial::evaluate(fit.b, seen.angle), settings.focal_px);
    const Vec3 exact = pinhole_ray(given.radius, given.angle, settings.focal_px);
    const Vec3 apart{fitted.x - exact.x, fitted.y - exact.y, fitted.z - exact.z};
    const float angle = 2.0F * math::asin(0.5F * math::sqrt(dot(apart, apart)));
    sum += static_cast<double>(angle) * static_cast<double>(angle);
    fit.worst_angle = math::max(fit.worst_angle, angle);
    fit.max_theta = math::max(fit.max_theta, math::atan2(given.radius, settings.focal_px));
  }
  fit.rms_angle = math::sqrt(static_cast<float>(sum / static_cast<double>(pairs.size())));
}

}  // namespace

Status fit_polynomial(std::span<const PointPair> pairs, const PolynomialFitSettings& settings, PolynomialFit& out,
                      const char** what) {
  const auto refuse = [what](const char* reason) {
    if (what != nullptr) *what = reason;
    return Status::invalid_argument;
  };
  if (const char* wrong = check(pairs, settings); wrong != nullptr) return refuse(wrong);
  float widest = 0.0F;
  for (const PointPair& pair : pairs) {
    widest = math::max(widest, polar(pair.distorted, settings.principal_point).radius);
  }
  if (!(widest > 0.0F)) return refuse("pairs do not cover the radius; add points from the centre to the edge");

  NormalEquations radial(settings.fit_a0 ? 0 : 1, settings.degree);
  NormalEquations angular(0, settings.degree);
  for (const PointPair& pair : pairs) {
    const Polar seen = polar(pair.distorted, settings.principal_point);
    const Polar given = polar(pair.pinhole, settings.principal_point);
    const double cos_squared = 1.0 / (1.0 + static_cast<double>(math::square(given.radius / settings.focal_px)));
    const double share = static_cast<double>(seen.radius / widest);
    radial.add(share, static_cast<double>(given.radius), cos_squared * cos_squared);
    const float turned = seen.angle + angle_difference(given.angle, seen.angle);
    angular.add(static_cast<double>(seen.angle / math::pi), static_cast<double>(turned), share * share);
  }
  PolynomialFit fit;
  if (!radial.solve(static_cast<double>(widest), fit.a)) {
    return refuse("pairs do not cover the radius; add points from the centre to the edge");
  }
  if (!angular.solve(static_cast<double>(math::pi), fit.b)) {
    return refuse("pairs do not cover the turn; add points in all directions");
  }
  measure(pairs, settings, fit);
  out = fit;
  return Status::ok;
}

}  // namespace touchline
