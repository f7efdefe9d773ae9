// SPDX-License-Identifier: Apache-2.0
// Ground projection against geometry worked out by hand, its own inverse, and finite differences.
#include "vision/lens/camera_pose.h"

#include <doctest/doctest.h>

#include <limits>

#include "platform/core/rng.h"
#include "tests/support/paper_lens.h"

using namespace touchline;

namespace {

const PixelPoint centre{376.0F, 240.0F};

GroundPoint axis_on_ground(const CameraPose& pose) {
  GroundPoint p;
  REQUIRE(GroundProjection(test::paper_lens(), pose).ground(centre, p));
  return p;
}

PixelPoint seen_at(const CameraPose& pose, const GroundPoint& point, float z = 0.0F) {
  PixelPoint p;
  REQUIRE(GroundProjection(test::paper_lens(), pose).pixel(point, z, p));
  return p;
}

}  // namespace

TEST_CASE("the optical axis meets the ground at height / tan(pitch), ahead") {
  const GroundPoint p = axis_on_ground({0.0F, 0.0F, 0.6F, 0.0F, radians(45.0F), 0.0F});
  CHECK(p.x == doctest::Approx(0.6));
  CHECK(p.y == doctest::Approx(0.0));
  const GroundPoint steep = axis_on_ground({0.1F, -0.2F, 0.6F, 0.0F, radians(60.0F), 0.0F});
  CHECK(steep.x == doctest::Approx(0.1 + 0.6 / 1.7320508));
  CHECK(steep.y == doctest::Approx(-0.2));
}

TEST_CASE("yaw > 0 looks left") {
  const GroundPoint p = axis_on_ground({0.0F, 0.0F, 0.5F, radians(90.0F), radians(45.0F), 0.0F});
  CHECK(math::abs(p.x) < 1e-6F);
  CHECK(p.y == doctest::Approx(0.5));
}

TEST_CASE("a mount that looks straight ahead: left is left in the image, near is low") {
  const CameraPose level{0.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.0F};
  CHECK(seen_at(level, {1.0F, 0.5F}).u < centre.u);
  CHECK(seen_at(level, {1.0F, 0.0F}).v > centre.v);
  CHECK(seen_at(level, {0.5F, 0.0F}).v > seen_at(level, {1.0F, 0.0F}).v);
  // 45 degrees below the horizon: r = f pi/4.
  CHECK(seen_at(level, {0.5F, 0.0F}).v == doctest::Approx(240.0 + 232.9 * 0.785398163));
  CHECK(seen_at(level, {1.0F, 0.0F}, 0.5F).v == doctest::Approx(240.0));
}

TEST_CASE("pitch > 0 looks down: what lies ahead moves up in the image") {
  CHECK(seen_at({0.0F, 0.0F, 0.5F, 0.0F, 0.3F, 0.0F}, {1.0F, 0.0F}).v <
        seen_at({0.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.0F}, {1.0F, 0.0F}).v);
}

TEST_CASE("roll > 0 lowers the right side: the horizon rises on the right of the image") {
  const CameraPose rolled{0.0F, 0.0F, 0.5F, 0.0F, 0.0F, radians(10.0F)};
  const PixelPoint left = seen_at(rolled, {1.0F, 1.0F}, 0.5F);
  const PixelPoint right = seen_at(rolled, {1.0F, -1.0F}, 0.5F);
  CHECK(right.v < centre.v);
  CHECK(left.v > centre.v);
}

TEST_CASE("any roll is legal: upside down, left and right, up and down change places") {
  const CameraPose upright{0.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.0F};
  const CameraPose upside_down{0.0F, 0.0F, 0.5F, 0.0F, 0.0F, math::pi};
  const PixelPoint a = seen_at(upright, {1.0F, 0.4F});
  const PixelPoint b = seen_at(upside_down, {1.0F, 0.4F});
  CHECK(a.u - centre.u == doctest::Approx(static_cast<double>(centre.u - b.u)));
  CHECK(a.v - centre.v == doctest::Approx(static_cast<double>(centre.v - b.v)));
}

TEST_CASE("at and above the horizon there is no ground, nor without a height") {
  const GroundProjection level(test::paper_lens(), {0.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.0F});
  GroundPoint p{7.0F, 7.0F};
  CHECK_FALSE(level.ground(centre, p));
  CHECK_FALSE(level.ground({376.0F, 100.0F}, p));
  CHECK_FALSE(level.ground({-100.0F, 240.0F}, p));
  CHECK(p.x == 7.0F);
  CHECK(level.ground({376.0F, 250.0F}, p));
  CHECK_FALSE(GroundProjection(test::paper_lens(), {0.0F, 0.0F, 0.0F, 0.0F, 0.5F, 0.0F}).ground(centre, p));
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  CHECK_FALSE(GroundProjection(test::paper_lens(), {0.0F, 0.0F, not_a_number, 0.0F, 0.5F, 0.0F}).ground(centre, p));
  CHECK_FALSE(GroundProjection(test::paper_lens(), {0.0F, 0.0F, 0.5F, 0.0F, not_a_number, 0.0F}).ground(centre, p));
  CHECK_FALSE(GroundProjection().ground(centre, p));
}

TEST_CASE("pixel to ground to pixel, for any attitude") {
  Rng rng(1);
  int seen = 0;
  float worst = 0.0F;
  for (int i = 0; i < 3000; ++i) {
    const CameraPose pose{rng.uniform(-0.1F, 0.1F), rng.uniform(-0.1F, 0.1F), rng.uniform(0.3F, 1.2F),
                          rng.uniform(-3.1F, 3.1F), rng.uniform(0.0F, 1.0F),  rng.uniform(-3.1F, 3.1F)};
    const GroundProjection projection(test::paper_lens(), pose);
    const PixelPoint p{rng.uniform(0.0F, 752.0F), rng.uniform(0.0F, 480.0F)};
    GroundPoint g;
    if (!projection.ground(p, g) || math::hypot(g.x, g.y) > 20.0F) continue;
    PixelPoint back;
    REQUIRE(projection.pixel(g, back));
    worst = math::max(worst, math::hypot(back.u - p.u, back.v - p.v));
    ++seen;
  }
  CHECK(seen > 1000);
  CHECK(worst < 2e-3F);
}

TEST_CASE("covariance: one pixel and the tilt by the definition, in small steps") {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const CameraPose pose{0.05F,
                          0.0F,
                          rng.uniform(0.4F, 1.1F),
                          rng.uniform(-1.0F, 1.0F),
                          rng.uniform(0.3F, 0.7F),
                          rng.uniform(-0.5F, 0.5F)};
    const GroundProjection projection(test::paper_lens(), pose);
    const PixelPoint p{rng.uniform(150.0F, 600.0F), rng.uniform(150.0F, 440.0F)};
    GroundPoint g;
    if (!projection.ground(p, g) || math::hypot(g.x, g.y) > 4.0F) continue;
    const float sigma_px = 1.5F;
    const float sigma_tilt = radians(0.5F);
    const float step = 1.0e-3F;  // radians
    const auto shift = [&](const GroundPoint& a, const GroundPoint& b, float scale) {
      return GroundPoint{(a.x - b.x) * scale, (a.y - b.y) * scale};
    };
    GroundPoint a, b;
    GroundPoint columns[4];
    REQUIRE((projection.ground({p.u + 0.5F, p.v}, a) && projection.ground({p.u - 0.5F, p.v}, b)));
    columns[0] = shift(a, b, sigma_px);
    REQUIRE((projection.ground({p.u, p.v + 0.5F}, a) && projection.ground({p.u, p.v - 0.5F}, b)));
    columns[1] = shift(a, b, sigma_px);
    CameraPose more = pose, less = pose;
    more.pitch += step;
    less.pitch -= step;
    REQUIRE((GroundProjection(test::paper_lens(), more).ground(p, a) &&
             GroundProjection(test::paper_lens(), less).ground(p, b)));
    columns[2] = shift(a, b, sigma_tilt / (2.0F * step));
    more = less = pose;
    more.roll += step;
    less.roll -= step;
    REQUIRE((GroundProjection(test::paper_lens(), more).ground(p, a) &&
             GroundProjection(test::paper_lens(), less).ground(p, b)));
    columns[3] = shift(a, b, sigma_tilt / (2.0F * step));
    Sym2 expected;
    for (const GroundPoint& c : columns) {
      expected.xx += c.x * c.x;
      expected.xy += c.x * c.y;
      expected.yy += c.y * c.y;
    }
    const Sym2 covariance = projection.ground_covariance(p, sigma_px, sigma_tilt);
    const float tolerance = 0.01F * (expected.xx + expected.yy);
    CHECK(math::abs(covariance.xx - expected.xx) < tolerance);
    CHECK(math::abs(covariance.xy - expected.xy) < tolerance);
    CHECK(math::abs(covariance.yy - expected.yy) < tolerance);
  }
}

TEST_CASE("half a degree of pitch is 6 cm at 2 m from half a metre of height") {
  const CameraPose pose{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};
  const GroundProjection projection(test::paper_lens(), pose);
  PixelPoint p;
  REQUIRE(projection.pixel({2.0F, 0.0F}, p));
  const Sym2 covariance = projection.ground_covariance(p, 0.0F, radians(0.5F));
  // dx = (h^2 + x^2) / h * dpitch
  CHECK(math::sqrt(covariance.xx) == doctest::Approx((0.58 * 0.58 + 4.0) / 0.58 * 0.00872664626).epsilon(1e-3));
}

TEST_CASE("where there is no ground the covariance says so") {
  const GroundProjection level(test::paper_lens(), {0.0F, 0.0F, 0.5F, 0.0F, 0.0F, 0.0F});
  CHECK(level.ground_covariance(centre, 1.0F, 0.01F).xx > 1e5F);
}
