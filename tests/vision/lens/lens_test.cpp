// SPDX-License-Identifier: Apache-2.0
// One suite of properties over every lens model, then what is particular to each.
#include "vision/lens/lens.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "platform/core/rng.h"
#include "vision/lens/barrel.h"
#include "vision/lens/polynomial.h"

using namespace touchline;

namespace {

struct NamedLens {
  const char* name;
  LensParameters parameters;
};

LensParameters basic(LensModel model, float focal_px, float max_theta_deg) {
  LensParameters p;
  p.model = model;
  p.focal_px = focal_px;
  p.cx = 376.0F;
  p.cy = 240.0F;
  p.max_theta = radians(max_theta_deg);
  return p;
}

/// Every model, some off centre, some at the ends of their range.
std::vector<NamedLens> all_lenses() {
  std::vector<NamedLens> lenses = {
      {"equidistant 185", basic(LensModel::equidistant, 232.9F, 92.5F)},
      {"equidistant 360", basic(LensModel::equidistant, 100.0F, 179.0F)},
      {"equisolid 140", basic(LensModel::equisolid, 420.0F, 70.0F)},
      {"equisolid 240", basic(LensModel::equisolid, 200.0F, 120.0F)},
      {"rectilinear", basic(LensModel::rectilinear, 990.3F, 45.8F)},
      {"kannala_brandt", basic(LensModel::kannala_brandt, 250.0F, 95.0F)},
      {"barrel", basic(LensModel::barrel, 232.9F, 80.0F)},
      {"pincushion", basic(LensModel::barrel, 500.0F, 40.0F)},
      {"polynomial", basic(LensModel::polynomial, 230.0F, 70.0F)},
      {"polynomial with angle", basic(LensModel::polynomial, 230.0F, 70.0F)},
  };
  lenses[2].parameters.cx = 655.5F;
  lenses[2].parameters.cy = 490.25F;
  lenses[5].parameters.k = {-0.02F, 0.004F, -0.001F, 0.0001F};
  lenses[6].parameters.alpha = 8.1e-6F;
  lenses[7].parameters.alpha = -2.0e-7F;
  lenses[8].parameters.a = {0.0F, 1.0F, 0.0F, 6.0e-6F, 0.0F, 2.0e-11F, 0.0F, 1.0e-17F};
  lenses[9].parameters.a = {0.0F, 1.01F, 0.0F, 6.0e-6F, 0.0F, 2.0e-11F};
  lenses[9].parameters.b = {0.0001F, 0.9987F, 0.0F, 5.27e-4F, 0.0F, -3.87e-5F};  // Table I
  return lenses;
}

Lens make(const LensParameters& parameters) {
  Lens lens;
  const char* what = "";
  const Status status = Lens::create(parameters, lens, &what);
  INFO(what);
  REQUIRE(status == Status::ok);
  return lens;
}

float angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 cross{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return math::atan2(math::sqrt(dot(cross, cross)), dot(a, b));
}

Vec3 direction(float theta, float phi) {
  return {math::sin(theta) * math::cos(phi), math::sin(theta) * math::sin(phi), math::cos(theta)};
}

const char* refusal(const LensParameters& parameters) {
  Lens lens;
  const char* what = nullptr;
  CHECK(Lens::create(parameters, lens, &what) == Status::invalid_argument);
  CHECK(Lens::create(parameters, lens) == Status::invalid_argument);
  return what == nullptr ? "" : what;
}

}  // namespace

TEST_CASE("pixel to ray to pixel is the identity inside the image circle") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    Rng rng(1);
    float worst = 0.0F;
    for (int i = 0; i < 2000; ++i) {
      const float r = lens.max_radius() * rng.uniform(0.0F, 0.9999F);
      const float phi = rng.uniform(-math::pi, math::pi);
      const PixelPoint p{named.parameters.cx + r * math::cos(phi), named.parameters.cy + r * math::sin(phi)};
      Vec3 ray;
      PixelPoint back;
      REQUIRE(lens.ray(p, ray));
      REQUIRE(math::abs(dot(ray, ray) - 1.0F) < 1e-6F);
      REQUIRE(lens.pixel(ray, back));
      worst = math::max(worst, math::hypot(back.u - p.u, back.v - p.v));
    }
    CHECK(worst < 2e-3F);
  }
}

TEST_CASE("ray to pixel to ray is the identity within the valid angle, whatever the ray's length") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    Rng rng(2);
    float worst = 0.0F;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 ray = direction(named.parameters.max_theta * rng.uniform(0.0F, 0.9999F), rng.uniform(-3.1F, 3.1F));
      const float length = rng.uniform(0.1F, 10.0F);
      PixelPoint p;
      Vec3 back;
      REQUIRE(lens.pixel({ray.x * length, ray.y * length, ray.z * length}, p));
      REQUIRE(lens.ray(p, back));
      worst = math::max(worst, angle_between(ray, back));
    }
    CHECK(worst < 2e-5F);
  }
}

TEST_CASE("many rays at once end at the pixels of each, bit for bit") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    Rng rng(3);
    int seen = 0, unseen = 0;
    for (int n = 0; n < 200; ++n) {
      RayLanes rays;
      for (rays.count = 0; rays.count <= n % RayLanes::most; ++rays.count) {
        const float length = rays.count % 5 == 4 ? 0.0F : rng.uniform(0.1F, 10.0F);
        const Vec3 ray = rays.count % 7 == 3 ? Vec3{0.0F, 0.0F, n % 2 == 0 ? 1.0F : -1.0F}
                                             : direction(rng.uniform(0.0F, math::pi), rng.uniform(-3.1F, 3.1F));
        rays.x[rays.count] = ray.x * length;
        rays.y[rays.count] = ray.y * length;
        rays.z[rays.count] = ray.z * length;
      }
      lens.pixels(rays);
      for (int i = 0; i < rays.count; ++i) {
        PixelPoint p;
        const bool sees = lens.pixel({rays.x[i], rays.y[i], rays.z[i]}, p);
        REQUIRE((rays.seen[i] == 1) == sees);
        ++(sees ? seen : unseen);
        if (!sees) continue;
        REQUIRE(rays.u[i] == p.u);
        REQUIRE(rays.v[i] == p.v);
      }
    }
    CHECK(seen > 100);
    CHECK(unseen > 20);
  }
}

TEST_CASE("the angle grows with the radius, from the axis to max_theta") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    float last = -1e-6F;
    for (int i = 0; i < 500; ++i) {
      const float r = lens.max_radius() * static_cast<float>(i) / 500.0F;
      Vec3 ray;
      REQUIRE(lens.ray({named.parameters.cx - r, named.parameters.cy}, ray));
      const float theta = math::atan2(math::hypot(ray.x, ray.y), ray.z);
      REQUIRE(theta > last);
      last = theta;
    }
    CHECK(last == doctest::Approx(static_cast<double>(named.parameters.max_theta)).epsilon(0.02));
  }
}

TEST_CASE("nothing is seen beyond max_theta, and what is refused stays unchanged") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    Vec3 ray{7.0F, 8.0F, 9.0F};
    const float outside = lens.max_radius() * 1.001F;
    CHECK_FALSE(lens.ray({named.parameters.cx, named.parameters.cy + outside}, ray));
    CHECK(ray.y == 8.0F);
    PixelPoint pixel{7.0F, 8.0F};
    CHECK_FALSE(lens.pixel(direction(named.parameters.max_theta * 1.001F, 1.0F), pixel));
    CHECK(pixel.v == 8.0F);
    CHECK(lens.pixel(direction(named.parameters.max_theta * 0.999F, 1.0F), pixel));
    const float not_a_number = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(lens.ray({not_a_number, 0.0F}, ray));
    CHECK_FALSE(lens.pixel({not_a_number, 0.0F, 1.0F}, pixel));
    CHECK_FALSE(lens.pixel({0.0F, 0.0F, 0.0F}, pixel));
  }
}

TEST_CASE("angles() is the first half of ray(), and takes what lies beyond the image circle for its edge") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    Lens lens;
    REQUIRE(Lens::create(named.parameters, lens) == Status::ok);
    constexpr int n = 50;
    Rng rng(4);
    float u[n], v[n], radius[n], theta[n];
    for (int i = 0; i < n; ++i) {
      u[i] = rng.uniform(-0.6F, 0.6F) * lens.max_radius();
      v[i] = i == 0 ? 5.0F * lens.max_radius() : rng.uniform(-0.6F, 0.6F) * lens.max_radius();
      radius[i] = math::hypot(u[i], v[i]);
    }
    float turned_u[n], turned_v[n];
    std::copy_n(u, n, turned_u);
    std::copy_n(v, n, turned_v);
    lens.angles(n, radius, turned_u, turned_v, theta);
    CHECK(theta[0] == doctest::Approx(lens.parameters().max_theta).epsilon(1e-4));
    for (int i = 1; i < n; ++i) {
      Vec3 ray;
      REQUIRE(lens.ray({lens.parameters().cx + u[i], lens.parameters().cy + v[i]}, ray));
      const float scale = math::sin(theta[i]) / radius[i];
      CHECK(turned_u[i] * scale == doctest::Approx(ray.x).epsilon(1e-4));
      CHECK(turned_v[i] * scale == doctest::Approx(ray.y).epsilon(1e-4));
      CHECK(math::cos(theta[i]) == doctest::Approx(ray.z).epsilon(1e-4));
    }
  }
}

TEST_CASE("the principal point sees along the axis, and x is right, y is down") {
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    const float cx = named.parameters.cx;
    const float cy = named.parameters.cy;
    Vec3 ray;
    REQUIRE(lens.ray({cx, cy}, ray));
    CHECK(ray.z == doctest::Approx(1.0));
    REQUIRE(lens.ray({cx + 50.0F, cy}, ray));
    CHECK(ray.x > 0.05F);
    CHECK(math::abs(ray.y) < 1e-3F);
    REQUIRE(lens.ray({cx, cy + 50.0F}, ray));
    CHECK(ray.y > 0.05F);
    CHECK(math::abs(ray.x) < 1e-3F);
  }
}

TEST_CASE("a lens without angular distortion looks the same all around") {
  for (const NamedLens& named : all_lenses()) {
    if (named.parameters.b[1] != 1.0F) continue;
    CAPTURE(named.name);
    const Lens lens = make(named.parameters);
    Vec3 first;
    REQUIRE(lens.ray({named.parameters.cx + 100.0F, named.parameters.cy}, first));
    for (int i = 1; i < 12; ++i) {
      const float phi = radians(30.0F * static_cast<float>(i));
      Vec3 turned;
      REQUIRE(lens.ray({named.parameters.cx + 100.0F * math::cos(phi), named.parameters.cy + 100.0F * math::sin(phi)},
                       turned));
      const Vec3 expected{first.x * math::cos(phi), first.x * math::sin(phi), first.z};
      CHECK(angle_between(turned, expected) < 2e-6F);
    }
  }
}

TEST_CASE("each formula at 30 degrees, by hand") {
  const double f = 200.0;
  const double theta = 0.5235987755982988;
  PixelPoint p;
  const Vec3 ray = direction(radians(30.0F), 0.0F);
  const auto radius = [&](LensParameters parameters) {
    REQUIRE(make(parameters).pixel(ray, p));
    return static_cast<double>(p.u) - 376.0;
  };
  CHECK(radius(basic(LensModel::equidistant, 200.0F, 80.0F)) == doctest::Approx(f * theta));
  CHECK(radius(basic(LensModel::equisolid, 200.0F, 80.0F)) == doctest::Approx(2.0 * f * std::sin(theta / 2.0)));
  CHECK(radius(basic(LensModel::rectilinear, 200.0F, 80.0F)) == doctest::Approx(f * std::tan(theta)));
  LensParameters kb = basic(LensModel::kannala_brandt, 200.0F, 80.0F);
  kb.k = {0.1F, -0.01F, 0.002F, -0.0003F};
  const double series = theta + 0.1 * std::pow(theta, 3) - 0.01 * std::pow(theta, 5) + 0.002 * std::pow(theta, 7) -
                        0.0003 * std::pow(theta, 9);
  CHECK(radius(kb) == doctest::Approx(f * series));
  LensParameters barrel = basic(LensModel::barrel, 200.0F, 80.0F);
  barrel.alpha = 8.1e-6F;
  const double r = radius(barrel);
  CHECK(r / (1.0 - 8.1e-6 * r * r) == doctest::Approx(f * std::tan(theta)));
}

TEST_CASE("barrel: no ray at and beyond the pole, and a wide max_theta ends at the model's own limit") {
  LensParameters p = basic(LensModel::barrel, 232.9F, 92.5F);
  p.alpha = 8.1e-6F;
  const Lens lens = make(p);
  const float pole = 1.0F / math::sqrt(p.alpha);  // 351 px
  CHECK(pole == doctest::Approx(351.4).epsilon(1e-3));
  CHECK(lens.max_radius() < pole);
  CHECK(lens.max_radius() > 0.99F * pole);
  Vec3 ray;
  CHECK_FALSE(lens.ray({p.cx + pole, p.cy}, ray));
  CHECK_FALSE(lens.ray({p.cx + 1.2F * pole, p.cy}, ray));
  REQUIRE(lens.ray({p.cx + 0.99F * pole, p.cy}, ray));
  CHECK(ray.z > 0.0F);
}

TEST_CASE("Table I of the paper: the polynomials' values, and that its printed digits are no lens") {
  LensParameters p = basic(LensModel::polynomial, 232.9F, 60.0F);
  p.a = {0.0336F, -1.6658F, 0.0759F, -0.0008F, 3.61e-6F, -5.78e-9F};
  p.b = {0.0001F, 0.9987F, 3.95e-17F, 5.27e-4F, -7.56e-18F, -3.87e-5F};
  // Sums of the printed terms, worked out by hand.
  CHECK(polynomial::evaluate(p.a, 0.0F) == doctest::Approx(0.0336));
  CHECK(polynomial::evaluate(p.a, 1.0F) == doctest::Approx(-1.557096394));
  CHECK(polynomial::evaluate(p.a, 10.0F) == doctest::Approx(-9.798878).epsilon(1e-5));
  CHECK(polynomial::evaluate(p.a, 100.0F) == doctest::Approx(95.6536).epsilon(1e-4));
  CHECK(polynomial::evaluate(p.a, 200.0F) == doctest::Approx(229.2736).epsilon(1e-5));
  CHECK(polynomial::evaluate(p.b, 1.0F) == doctest::Approx(0.9992883));
  CHECK(polynomial::evaluate(p.b, -1.0F) == doctest::Approx(-0.9990883));
  CHECK(polynomial::evaluate(p.b, 3.0F) == doctest::Approx(3.0010249));
  CHECK(polynomial::slope(p.b, 2.0F) == doctest::Approx(0.9987 + 3.0 * 5.27e-4 * 4.0 - 5.0 * 3.87e-5 * 16.0));
  CHECK(refusal(p)[0] == 'a');
}

TEST_CASE("polynomial of degree 7: every coefficient counts") {
  const std::array<float, 8> c{1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F};
  CHECK(polynomial::evaluate(c, 2.0F) == 1793.0F);  // sum (i + 1) 2^i
  CHECK(polynomial::slope(c, 1.0F) == 168.0F);      // sum i (i + 1)
}

TEST_CASE("bad parameters are refused with the key's name") {
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const NamedLens& named : all_lenses()) {
    CAPTURE(named.name);
    for (const float bad : {not_a_number, infinity, -infinity}) {
      LensParameters p = named.parameters;
      p.focal_px = bad;
      CHECK(std::string(refusal(p)).find("focal_px") == 0);
      p = named.parameters;
      p.cx = bad;
      CHECK(std::string(refusal(p)).find("cx") == 0);
      p = named.parameters;
      p.cy = bad;
      CHECK(std::string(refusal(p)).find("cy") == 0);
      p = named.parameters;
      p.max_theta = bad;
      CHECK(std::string(refusal(p)).find("max_theta_deg") == 0);
      p = named.parameters;
      p.k[2] = bad;
      CHECK(std::string(refusal(p)).find("k1..k4") == 0);
      p = named.parameters;
      p.alpha = bad;
      CHECK(std::string(refusal(p)).find("alpha") == 0);
      p = named.parameters;
      p.a[7] = bad;
      CHECK(std::string(refusal(p)).find("a ") == 0);
      p = named.parameters;
      p.b[0] = bad;
      CHECK(std::string(refusal(p)).find("b ") == 0);
    }
    LensParameters p = named.parameters;
    p.focal_px = 0.0F;
    CHECK(std::string(refusal(p)).find("focal_px") == 0);
    p = named.parameters;
    p.max_theta = 0.0F;
    CHECK(std::string(refusal(p)).find("max_theta_deg") == 0);
    p.max_theta = radians(181.0F);
    CHECK(std::string(refusal(p)).find("max_theta_deg") == 0);
  }
}

TEST_CASE("models that turn back before max_theta are refused") {
  LensParameters kb = basic(LensModel::kannala_brandt, 250.0F, 95.0F);
  kb.k = {-0.3F, 0.0F, 0.0F, 0.0F};
  CHECK(std::string(refusal(kb)).find("k1..k4") == 0);
  kb.max_theta = radians(50.0F);
  make(kb);
  LensParameters pincushion = basic(LensModel::barrel, 232.9F, 80.0F);
  pincushion.alpha = -8.1e-6F;
  CHECK(std::string(refusal(pincushion)).find("alpha") != std::string::npos);
  LensParameters flat = basic(LensModel::polynomial, 232.9F, 60.0F);
  flat.a = {0.0F, 1.0F, 0.0F, -1e-5F};
  CHECK(refusal(flat)[0] == 'a');
  LensParameters twisted = all_lenses()[9].parameters;
  twisted.b = {0.0F, 0.9F};
  CHECK(refusal(twisted)[0] == 'b');
  twisted.b = {0.0F, -1.0F};
  CHECK(refusal(twisted)[0] == 'b');
}

TEST_CASE("a lens that was never created sees nothing") {
  const Lens lens;
  Vec3 ray;
  PixelPoint pixel;
  CHECK_FALSE(lens.ray({0.0F, 0.0F}, ray));
  CHECK_FALSE(lens.pixel({0.0F, 0.0F, 1.0F}, pixel));
}
