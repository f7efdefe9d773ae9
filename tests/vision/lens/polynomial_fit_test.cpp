// SPDX-License-Identifier: Apache-2.0
// The regression against lenses that are known: a polynomial is found again, a fish-eye is followed as closely as the
// degree allows, and the result is a lens.
#include "vision/lens/polynomial_fit.h"

#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "platform/core/rng.h"
#include "vision/lens/lens.h"

using namespace touchline;

namespace {

constexpr float focal_px = 232.9F;

LensParameters base(LensModel model, float max_theta_deg) {
  LensParameters p;
  p.model = model;
  p.focal_px = focal_px;
  p.cx = 380.5F;
  p.cy = 236.0F;
  p.max_theta = radians(max_theta_deg);
  return p;
}

Lens make(const LensParameters& parameters) {
  Lens lens;
  const char* what = "";
  const Status status = Lens::create(parameters, lens, &what);
  INFO(what);
  REQUIRE(status == Status::ok);
  return lens;
}

PolynomialFitSettings settings(int degree) { return {degree, focal_px, {380.5F, 236.0F}, false}; }

/// What a calibration target would give: points all over the image circle up to max_theta.
std::vector<PointPair> sample(const Lens& lens, float max_theta_deg) {
  std::vector<PointPair> pairs;
  const float cx = lens.parameters().cx;
  const float cy = lens.parameters().cy;
  for (int ring = 1; ring <= 40; ++ring) {
    for (int spoke = 0; spoke < 36; ++spoke) {
      const float theta = radians(max_theta_deg) * static_cast<float>(ring) / 40.0F;
      const float phi = radians(10.0F * static_cast<float>(spoke) - 177.0F);
      const Vec3 ray{math::sin(theta) * math::cos(phi), math::sin(theta) * math::sin(phi), math::cos(theta)};
      PixelPoint seen;
      REQUIRE(lens.pixel(ray, seen));
      pairs.push_back({seen, {cx + focal_px * ray.x / ray.z, cy + focal_px * ray.y / ray.z}});
    }
  }
  return pairs;
}

/// Largest angle between the rays of two lenses, over pixels up to `radius`.
float worst_difference(const Lens& a, const Lens& b, float radius) {
  Rng rng(1);
  float worst = 0.0F;
  for (int i = 0; i < 3000; ++i) {
    const float r = radius * math::sqrt(rng.uniform());
    const float phi = rng.uniform(-math::pi, math::pi);
    const PixelPoint p{380.5F + r * math::cos(phi), 236.0F + r * math::sin(phi)};
    Vec3 one, other;
    REQUIRE((a.ray(p, one) && b.ray(p, other)));
    const Vec3 apart{one.x - other.x, one.y - other.y, one.z - other.z};
    worst = math::max(worst, math::sqrt(dot(apart, apart)));
  }
  return worst;
}

Lens fitted_lens(const PolynomialFit& fit, float max_theta_deg) {
  LensParameters p = base(LensModel::polynomial, max_theta_deg);
  p.a = fit.a;
  p.b = fit.b;
  return make(p);
}

}  // namespace

TEST_CASE("a polynomial lens is found again, angle included") {
  LensParameters p = base(LensModel::polynomial, 70.0F);
  p.a = {0.0F, 1.01F, 1e-4F, 6.0e-6F, 1e-9F, 2.0e-11F};
  p.b = {0.0001F, 0.9987F, 0.0F, 5.27e-4F, 0.0F, -3.87e-5F};  // Table I
  const Lens lens = make(p);
  for (const int degree : {5, 7}) {
    PolynomialFit fit;
    REQUIRE(fit_polynomial(sample(lens, 69.0F), settings(degree), fit) == Status::ok);
    CHECK(fit.worst_angle < 1e-5F);
    CHECK(fit.b[1] == doctest::Approx(0.9987).epsilon(1e-3));
    CHECK(worst_difference(lens, fitted_lens(fit, 69.0F), 0.97F * lens.max_radius()) < 2e-5F);
  }
}

TEST_CASE("an equidistant fish-eye is followed to 75 degrees, better with degree 7 than with 5") {
  const Lens lens = make(base(LensModel::equidistant, 92.5F));
  const auto pairs = sample(lens, 75.0F);
  struct Expected {
    int degree;
    float worst_deg, rms_deg;  // the same least squares in another program: 0.598, 0.163 and 0.098, 0.030
    float between_deg;         // also between the pairs
  };
  for (const Expected& e : {Expected{5, 0.61F, 0.165F, 0.72F}, Expected{7, 0.10F, 0.031F, 0.15F}}) {
    PolynomialFit fit;
    REQUIRE(fit_polynomial(pairs, settings(e.degree), fit) == Status::ok);
    CHECK(degrees(fit.worst_angle) < e.worst_deg);
    CHECK(degrees(fit.rms_angle) < e.rms_deg);
    CHECK(degrees(fit.max_theta) == doctest::Approx(75.0));
    CHECK(fit.a[0] == 0.0F);
    CHECK((e.degree == 7 || (fit.a[6] == 0.0F && fit.a[7] == 0.0F && fit.b[6] == 0.0F)));
    CHECK(math::abs(fit.b[0]) < 1e-5F);
    CHECK(fit.b[1] == doctest::Approx(1.0).epsilon(1e-4));
    const Lens polynomial = fitted_lens(fit, 74.0F);
    CHECK(degrees(worst_difference(lens, polynomial, focal_px * radians(73.5F))) < e.between_deg);
  }
}

TEST_CASE("noise of half a pixel on the pairs does not carry into the lens") {
  const Lens lens = make(base(LensModel::equidistant, 92.5F));
  auto pairs = sample(lens, 60.0F);
  Rng rng(3);
  for (PointPair& pair : pairs) {
    pair.distorted.u += 0.5F * rng.gaussian();
    pair.distorted.v += 0.5F * rng.gaussian();
  }
  PolynomialFit fit;
  REQUIRE(fit_polynomial(pairs, settings(7), fit) == Status::ok);
  CHECK(degrees(worst_difference(lens, fitted_lens(fit, 59.0F), focal_px * radians(58.0F))) < 0.1F);
}

TEST_CASE("a0 is fitted when asked for") {
  const Lens lens = make(base(LensModel::equidistant, 92.5F));
  PolynomialFitSettings free = settings(5);
  free.fit_a0 = true;
  PolynomialFit fit;
  REQUIRE(fit_polynomial(sample(lens, 70.0F), free, fit) == Status::ok);
  CHECK(fit.a[0] == doctest::Approx(-1.239).epsilon(1e-3));
}

TEST_CASE("pairs that determine nothing are refused, and say why") {
  const Lens lens = make(base(LensModel::equidistant, 92.5F));
  const auto good = sample(lens, 60.0F);
  PolynomialFit fit;
  fit.max_theta = 7.0F;
  const char* what = "";
  const auto refused = [&](const std::vector<PointPair>& pairs, const PolynomialFitSettings& s) {
    what = "";
    CHECK(fit_polynomial(pairs, s, fit, &what) == Status::invalid_argument);
    CHECK(fit_polynomial(pairs, s, fit) == Status::invalid_argument);
    CHECK(fit.max_theta == 7.0F);
    return std::string(what);
  };
  CHECK(refused(good, settings(6)).find("degree") == 0);
  PolynomialFitSettings s = settings(5);
  s.focal_px = std::numeric_limits<float>::quiet_NaN();
  CHECK(refused(good, s).find("focal_px") == 0);
  s = settings(5);
  s.principal_point.v = std::numeric_limits<float>::infinity();
  CHECK(refused(good, s).find("principal_point") == 0);
  auto broken = good;
  broken[7].pinhole.u = std::numeric_limits<float>::quiet_NaN();
  CHECK(refused(broken, settings(5)).find("pairs") == 0);
  CHECK(refused({}, settings(5)).find("radius") != std::string::npos);
  CHECK(refused({good.begin(), good.begin() + 36}, settings(5)).find("radius") != std::string::npos);  // one ring
  std::vector<PointPair> spoke;
  for (std::size_t i = 0; i < good.size(); i += 36) spoke.push_back(good[i]);
  CHECK(refused(spoke, settings(5)).find("turn") != std::string::npos);
}
