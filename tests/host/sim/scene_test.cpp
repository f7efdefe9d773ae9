// SPDX-License-Identifier: Apache-2.0
// A pixel's share of paint follows geometry alone.
#include "platform/host/sim/scene.h"

#include <doctest/doctest.h>

#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

/// 0: carpet, 1: paint, by the red channel of the plain scene.
float paint_share(const Ground& ground, const GroundOptions& o, float x, float y, float half) {
  const Footprint pixel{half, 0.0F, 0.0F, half};
  return (ground.color(x, y, pixel).r - o.carpet.r) / (o.paint.r - o.carpet.r);
}

}  // namespace

TEST_CASE("ground: lines lie where the field's dimensions say") {
  const SceneOptions o = plain_scene(small_field());
  Ground ground;
  ground.build(o.field, o.ground, 1);
  const float tiny = 0.001F;
  CHECK(paint_share(ground, o.ground, 2.45F, 0.3F, tiny) == doctest::Approx(1.0F).epsilon(0.002));
  CHECK(paint_share(ground, o.ground, 2.45F + 0.048F, 0.3F, tiny) == doctest::Approx(1.0F).epsilon(0.002));
  CHECK(paint_share(ground, o.ground, 2.45F + 0.053F, 0.3F, tiny) == doctest::Approx(0.0F));
  CHECK(paint_share(ground, o.ground, 0.0F, 0.5F, tiny) == doctest::Approx(1.0F).epsilon(0.002));
  CHECK(paint_share(ground, o.ground, 0.3F, 0.4F, tiny) == doctest::Approx(1.0F).epsilon(0.002));  // the circle
  CHECK(paint_share(ground, o.ground, 0.3F, 0.3F, tiny) == doctest::Approx(0.0F));
  CHECK(paint_share(ground, o.ground, 2.05F, 0.5F, tiny) == doctest::Approx(1.0F).epsilon(0.002));   // goal area
  CHECK(paint_share(ground, o.ground, 1.25F, 0.02F, tiny) == doctest::Approx(1.0F).epsilon(0.002));  // penalty mark
  CHECK(paint_share(ground, o.ground, 2.49F, 1.49F, tiny) ==
        doctest::Approx(1.0F).epsilon(0.002));  // the corner is square
}

TEST_CASE("ground: coverage is the share of the pixel's area") {
  const SceneOptions o = plain_scene(small_field());
  Ground ground;
  ground.build(o.field, o.ground, 1);
  CHECK(paint_share(ground, o.ground, 2.40F, 0.3F, 0.01F) == doctest::Approx(0.5F).epsilon(0.01));
  CHECK(paint_share(ground, o.ground, 2.45F, 0.3F, 0.10F) == doctest::Approx(0.5F).epsilon(0.01));
  // The same whether near cells or all marks are tried.
  const float below = paint_share(ground, o.ground, 0.02F, 1.0F, 0.1999F);
  const float above = paint_share(ground, o.ground, 0.02F, 1.0F, 0.2001F);
  CHECK(below == doctest::Approx(above).epsilon(0.01));
}

TEST_CASE("ground: worn paint is darker; the carpet ends at its border") {
  SceneOptions o = plain_scene(small_field());
  o.ground.wear = 0.5F;
  Ground ground;
  ground.build(o.field, o.ground, 1);
  float sum = 0.0F;
  for (int i = 0; i < 100; ++i)
    sum += paint_share(ground, o.ground, 2.45F, -1.0F + 0.02F * static_cast<float>(i), 0.001F);
  CHECK(sum / 100.0F == doctest::Approx(0.5F).epsilon(0.2));
  const Footprint pixel{0.001F, 0.0F, 0.0F, 0.001F};
  const Rgb inside = ground.color(3.09F, 0.0F, pixel);
  const Rgb outside = ground.color(3.11F, 0.0F, pixel);
  CHECK(inside.g > 2.0F * inside.r);
  CHECK(outside.g < 1.5F * outside.r);
}

TEST_CASE("scene: the same seed gives the same choices, and all lights occur") {
  int seen[3] = {};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const SceneOptions a = random_scene(small_field(), seed);
    const SceneOptions b = random_scene(small_field(), seed);
    CHECK(a.robots == b.robots);
    CHECK(a.ground.wear == b.ground.wear);
    CHECK(a.light == b.light);
    seen[static_cast<int>(a.light)] += 1;
  }
  for (const int n : seen) CHECK(n > 5);
}
