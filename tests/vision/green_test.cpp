// SPDX-License-Identifier: Apache-2.0
// The carpet's colour under several lights, and what is white on it.
#include "vision/green.h"

#include <doctest/doctest.h>

#include "tests/support/ascii_image.h"
#include "tests/vision/painted_field.h"
#include "vision/image/bit_ops.h"
#include "vision/image/grid_point.h"
#include "vision/vision_config.h"

using namespace touchline;
using namespace touchline::test;

namespace {

constexpr int w = 320, h = 240;

struct Masks {
  CarpetModel carpet;
  Bits green{w, h}, white{w, h};
};

Masks look(const Scene& scene) {
  const GroundProjection projection(test::paper_lens(), usual_pose());
  WorkImage image = work_image(paint(scene, projection));
  Bits ground(w, h);
  for (int y = 120; y < h; ++y) set_span(ground.view(), y, 40, 280, true);
  Masks m;
  m.carpet = measure_carpet(image.view(), ground.view(), VisionConfig{}.green, m.green.view());
  find_white(image.view(), ground.view(), m.carpet, m.white.view());
  return m;
}

Scene scene_with_everything() {
  Scene scene;
  scene.noise = 4.0F;
  scene.stripes = {{{0.5F, -2.0F}, {0.5F, 2.0F}, 0.10F, line_white},
                   {{1.0F, -0.5F}, {1.0F, -0.3F}, 0.15F, {220, 180, 30}}};  // a post's yellow, lying on the carpet
  return scene;
}

int pixels(const Bits& mask, int x0, int y0, int x1, int y1) {
  int n = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) n += mask.view().get(x, y) ? 1 : 0;
  }
  return n;
}

/// Working pixel of a ground point.
GridPoint work_pixel(const GroundPoint& p) {
  const GroundProjection projection(test::paper_lens(), usual_pose());
  PixelPoint pixel;
  REQUIRE(projection.pixel(p, pixel));
  return {static_cast<std::int16_t>(pixel.u / 2.35F), static_cast<std::int16_t>(pixel.v / 2.0F)};
}

}  // namespace

TEST_CASE("carpet is green, a line is white, yellow is neither, in any light") {
  for (const Rgb light : {Rgb{1, 1, 1}, Rgb{0.3F, 0.3F, 0.3F}, Rgb{0.75F, 0.6F, 0.42F}, Rgb{1.15F, 1.15F, 1.2F}}) {
    Scene scene = scene_with_everything();
    scene.light = light;
    scene.noise = 4.0F * light.g;
    CAPTURE(light.r);
    CAPTURE(light.b);
    const Masks m = look(scene);
    const GridPoint carpet = work_pixel({0.75F, 0.3F});
    const GridPoint line = work_pixel({0.5F, 0.0F});
    const GridPoint yellow = work_pixel({1.0F, -0.4F});
    CHECK(pixels(m.green, carpet.x - 3, carpet.y - 3, carpet.x + 3, carpet.y + 3) == 36);
    CHECK(pixels(m.white, carpet.x - 3, carpet.y - 3, carpet.x + 3, carpet.y + 3) == 0);
    CHECK(pixels(m.green, line.x - 3, line.y - 2, line.x + 3, line.y + 2) == 0);
    CHECK(pixels(m.white, line.x - 3, line.y - 2, line.x + 3, line.y + 2) == 24);
    CHECK(pixels(m.green, yellow.x - 2, yellow.y - 1, yellow.x + 2, yellow.y + 1) == 0);
    CHECK(pixels(m.white, yellow.x - 2, yellow.y - 1, yellow.x + 2, yellow.y + 1) == 0);
  }
}

TEST_CASE("a shadow's edge is no edge: carpet on both sides of it is green") {
  Scene scene = scene_with_everything();
  scene.shadow_from_y = 0.0F;
  const Masks m = look(scene);
  const GridPoint edge = work_pixel({0.8F, 0.0F});
  CHECK(pixels(m.green, edge.x - 6, edge.y - 2, edge.x + 6, edge.y + 2) == 48);
  CHECK(pixels(m.white, edge.x - 6, edge.y - 2, edge.x + 6, edge.y + 2) == 0);
  const GridPoint shaded = work_pixel({0.5F, 0.4F});
  CHECK(pixels(m.white, shaded.x - 2, shaded.y - 2, shaded.x + 2, shaded.y + 2) == 16);
}

TEST_CASE("the noise is measured, and lines hardly disturb it") {
  Scene scene;
  scene.noise = 8.0F;  // of a camera pixel and channel; 4.7 camera pixels and three weighted channels make a luma
  const float expected = 8.0F * 0.668F / math::sqrt(4.7F) * 16.0F;
  CHECK(static_cast<float>(look(scene).carpet.noise) == doctest::Approx(expected).epsilon(0.15));
  scene.stripes = scene_with_everything().stripes;
  CHECK(static_cast<float>(look(scene).carpet.noise) == doctest::Approx(expected).epsilon(0.35));
}

TEST_CASE("without a carpet nothing is green and nothing is white") {
  Scene scene;
  scene.carpet = {120, 90, 70};  // wood
  const Masks m = look(scene);
  CHECK(m.carpet.samples == 0);
  CHECK(count(m.green.view()) == 0);
  CHECK(count(m.white.view()) == 0);
}
