// SPDX-License-Identifier: Apache-2.0
// Rays meet capsules, spheres and boxes where geometry says, and shadows lie where the sun does not reach.
#include "platform/host/sim/solids.h"

#include <doctest/doctest.h>

#include "platform/core/rng.h"
#include "platform/host/sim/light_map.h"

using namespace touchline;
using namespace touchline::sim;

TEST_CASE("solids: a ray enters a sphere, an upright post and a turned box at the right distance") {
  const Material m;
  SolidHit hit;
  const Vec3 origin{0.0F, 0.0F, 0.5F};
  const Vec3 ahead{1.0F, 0.0F, 0.0F};
  REQUIRE(intersect(make_sphere({3.0F, 0.0F, 0.5F}, 0.25F, m), origin, ahead, 100.0F, hit));
  CHECK(hit.t == doctest::Approx(2.75F));
  CHECK(hit.normal.x == doctest::Approx(-1.0F));
  REQUIRE(intersect(make_capsule({3.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 1.0F}, 0.05F, m), origin, ahead, 100.0F, hit));
  CHECK(hit.t == doctest::Approx(2.95F));
  REQUIRE(intersect(make_box({3.0F, 0.0F, 0.5F}, {0.5F, 0.1F, 0.5F}, math::half_pi, m), origin, ahead, 100.0F, hit));
  CHECK(hit.t == doctest::Approx(2.9F));
  CHECK(hit.normal.x == doctest::Approx(-1.0F));
}

TEST_CASE("solids: behind, beside or beyond the limit is no hit") {
  const Material m;
  SolidHit hit;
  const Vec3 ahead{1.0F, 0.0F, 0.0F};
  const Solid sphere = make_sphere({3.0F, 0.0F, 0.0F}, 0.25F, m);
  CHECK_FALSE(intersect(sphere, {0.0F, 0.3F, 0.0F}, ahead, 100.0F, hit));
  CHECK_FALSE(intersect(sphere, {4.0F, 0.0F, 0.0F}, ahead, 100.0F, hit));
  CHECK_FALSE(intersect(sphere, {0.0F, 0.0F, 0.0F}, ahead, 2.5F, hit));
  const Solid post = make_capsule({3.0F, 0.0F, 0.0F}, {3.0F, 0.0F, 1.0F}, 0.05F, m);
  CHECK_FALSE(intersect(post, {0.0F, 0.0F, 1.2F}, ahead, 100.0F, hit));
}

TEST_CASE("solids: every hit lies on the surface") {
  Rng rng(11);
  const Material m;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 a{rng.uniform(-1.0F, 1.0F), rng.uniform(-1.0F, 1.0F), rng.uniform(0.0F, 1.0F)};
    const Vec3 b = a + Vec3{rng.uniform(-0.5F, 0.5F), rng.uniform(-0.5F, 0.5F), rng.uniform(-0.5F, 0.5F)};
    const Solid s = make_capsule(a, b, 0.2F, m);
    const Vec3 origin{-4.0F, rng.uniform(-1.0F, 1.0F), 0.5F};
    const Vec3 way = normalized(Vec3{4.0F, rng.uniform(-1.0F, 1.0F), rng.uniform(-0.5F, 0.5F)});
    SolidHit hit;
    if (!intersect(s, origin, way, 100.0F, hit)) continue;
    hits += 1;
    const Vec3 p = origin + way * hit.t;
    const Vec3 axis = b - a;
    const float along = math::clamp(dot(p - a, axis) / dot(axis, axis), 0.0F, 1.0F);
    const Vec3 off = p - (a + axis * along);
    CHECK(math::sqrt(dot(off, off)) == doctest::Approx(0.2F).epsilon(0.01));
  }
  CHECK(hits > 100);
}

TEST_CASE("light: lamps cast soft dark under a body, none far from it") {
  Room room;
  const float margin[4] = {1.0F, 1.0F, 1.0F, 1.0F};
  room.build(3.0F, 2.0F, margin, RoomOptions{}, 1);
  LightMap map;
  map.build(3.0F, 2.0F, {0.0F, 0.0F, 0.0F}, room, {});
  const float free = map.at(0.5F, 0.5F);
  const float far = map.at(2.0F, -1.0F);
  const Solid foot[1] = {make_box({0.5F, 0.5F, 0.03F}, {0.1F, 0.1F, 0.03F}, 0.0F, Material{})};
  map.set_moving(foot);
  CHECK(map.at(0.5F, 0.5F) < 0.9F * free);
  CHECK(map.at(2.0F, -1.0F) == far);
  map.set_moving({});
  CHECK(map.at(0.5F, 0.5F) == free);
}

TEST_CASE("light: the sun's shadow of a post lies away from the sun, inside a sunlit patch") {
  Room room;
  const float margin[4] = {1.0F, 1.0F, 1.0F, 1.0F};
  room.build(3.0F, 2.0F, margin, RoomOptions{}, 1);
  const Vec3 to_sun = normalized(Vec3{1.0F, 0.6F, 0.6F});
  LightMap map;
  map.build(3.0F, 2.0F, to_sun, room, {});
  int patches = 0;
  for (float x = -2.5F; x < 2.5F; x += 0.05F) {
    for (float y = -1.5F; y < 1.5F; y += 0.05F) {
      const bool through = room.through_window({x, y, 0.0F}, to_sun);
      if (through) patches += 1;
      if (!through || map.at(x, y) < 0.99F) continue;
      // A post whose shadow's middle falls here: half way up it, toward the sun.
      const Vec3 at = Vec3{x, y, 0.0F} + to_sun * (0.5F / to_sun.z);
      const Solid post[1] = {make_capsule({at.x, at.y, 0.0F}, {at.x, at.y, 1.0F}, 0.06F, Material{})};
      map.set_moving(post);
      CHECK(map.at(x, y) < 0.5F);
      map.set_moving({});
      CHECK(map.at(x, y) > 0.99F);
      x += 0.5F;
      break;
    }
  }
  CHECK(patches > 5);
}
