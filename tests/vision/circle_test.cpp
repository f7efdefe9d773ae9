// SPDX-License-Identifier: Apache-2.0
#include "vision/circle.h"

#include <doctest/doctest.h>

#include "tests/vision/drawn_ground.h"

namespace touchline {
namespace {

using test::Scene;
using test::Seen;

}  // namespace

TEST_CASE("a whole circle with the half line: centre, direction, and two X's where they cut") {
  for (const float r : {0.5F, 0.75F}) {
    CAPTURE(r);
    Scene scene;
    const GroundPoint centre{1.5F, 0.2F};
    scene.circles = {{centre, r}};
    scene.lines = {{{centre.x - 0.3F, -2.0F}, {centre.x + 0.3F, 2.4F}}};  // 82.2 degrees, through the centre
    const Seen seen(scene, r);
    REQUIRE(seen.features->has_circle);
    const CircleObservation& c = seen.features->circle;
    CHECK(math::hypot(c.centre.x - centre.x, c.centre.y - centre.y) < 0.03F);
    CHECK(c.arc > radians(300.0F));
    REQUIRE(c.has_half_line);
    CHECK(math::abs(angle_difference(c.half_line_direction, math::atan2(4.4F, 0.6F))) < radians(3.0F));
    CHECK(c.covariance.xx > 0.0F);
    CHECK(seen.count(JunctionType::x) == 2);
    for (const float side : {-1.0F, 1.0F}) {
      const float h = math::hypot(0.6F, 4.4F);
      const GroundPoint cut{centre.x + side * r * 0.6F / h, centre.y + side * r * 4.4F / h};
      const Junction* x = seen.nearest(JunctionType::x, cut);
      REQUIRE(x != nullptr);
      CHECK(seen.pixels_off(*x, cut) < 4.0F);
    }
  }
}

TEST_CASE("a large circle that the picture cuts") {
  Scene scene;
  const GroundPoint centre{1.9F, 0.0F};
  scene.circles = {{centre, 1.5F}};
  const Seen seen(scene, 1.5F);
  REQUIRE(seen.features->has_circle);
  CHECK(math::hypot(seen.features->circle.centre.x - centre.x, seen.features->circle.centre.y - centre.y) < 0.05F);
  CHECK_FALSE(seen.features->circle.has_half_line);
}

TEST_CASE("a quarter of the circle is enough, a tenth is not") {
  Scene scene;
  const GroundPoint centre{1.2F, 0.0F};
  scene.circles = {{centre, 0.5F, 0.3F, 2.2F}};
  const Seen quarter(scene, 0.5F);
  REQUIRE(quarter.features->has_circle);
  CHECK(math::hypot(quarter.features->circle.centre.x - centre.x, quarter.features->circle.centre.y - centre.y) <
        0.08F);
  CHECK(quarter.features->circle.arc < radians(150.0F));
  scene.circles = {{centre, 0.5F, 0.3F, 0.9F}};
  CHECK_FALSE(Seen(scene, 0.5F).features->has_circle);
}

TEST_CASE("corners are no circles, whether near or far, nor is a goal area") {
  for (const float x : {0.5F, 1.0F, 1.6F, 2.2F}) {
    CAPTURE(x);
    Scene scene;
    scene.lines = {{{x, 0.2F}, {x, 1.8F}}, {{x, 0.2F}, {x + 1.8F, 0.2F}}};
    CHECK_FALSE(Seen(scene, 0.5F).features->has_circle);
    scene.lines = {{{x + 0.4F, -1.5F}, {x + 0.4F, 1.5F}}, {{x, 0.5F}, {x + 0.4F, 0.5F}}, {{x, 0.5F}, {x, -1.3F}}};
    CHECK_FALSE(Seen(scene, 0.5F).features->has_circle);
  }
}

TEST_CASE("a circle of another radius is not the centre circle") {
  Scene scene;
  scene.circles = {{{1.5F, 0.0F}, 0.5F}};
  CHECK_FALSE(Seen(scene, 0.85F).features->has_circle);
  CHECK_FALSE(Seen(scene, 0.0F).features->has_circle);
}

}  // namespace touchline
