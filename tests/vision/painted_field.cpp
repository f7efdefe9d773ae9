// SPDX-License-Identifier: Apache-2.0
#include "tests/vision/painted_field.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "platform/core/rng.h"
#include "vision/image/subsample.h"

namespace touchline::test {
namespace {

bool covers(const Stripe& s, const GroundPoint& p) {
  const float dx = s.b.x - s.a.x, dy = s.b.y - s.a.y;
  const float t = std::clamp(((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / (dx * dx + dy * dy), 0.0F, 1.0F);
  return std::hypot(p.x - s.a.x - t * dx, p.y - s.a.y - t * dy) <= 0.5F * s.width;
}

Rgb colour_at(const Scene& scene, const GroundProjection& projection, const PixelPoint& pixel) {
  Vec3 ray;
  if (!projection.robot_ray(pixel, ray)) return {0, 0, 0};
  GroundPoint p;
  if (!projection.ground(pixel, p)) return wall_grey;
  Rgb c = std::hypot(p.x, p.y) < scene.carpet_radius ? scene.carpet : scene.floor;
  for (const Stripe& s : scene.stripes) {
    if (covers(s, p)) c = s.colour;
  }
  const float shade = p.y > scene.shadow_from_y ? scene.shadow : 1.0F;
  return {c.r * scene.light.r * shade, c.g * scene.light.g * shade, c.b * scene.light.b * shade};
}

std::uint8_t level(float v) { return static_cast<std::uint8_t>(std::clamp(v + 0.5F, 0.0F, 255.0F)); }

}  // namespace

CameraPose usual_pose() { return {0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F}; }

Picture paint(const Scene& scene, const GroundProjection& projection, int width, int height) {
  Picture picture{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height * 3))};
  Rng rng(scene.seed);
  std::size_t at = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      Rgb sum;
      for (const float du : {0.25F, 0.75F}) {
        for (const float dv : {0.25F, 0.75F}) {
          const Rgb c = colour_at(scene, projection, {static_cast<float>(x) + du, static_cast<float>(y) + dv});
          sum = {sum.r + 0.25F * c.r, sum.g + 0.25F * c.g, sum.b + 0.25F * c.b};
        }
      }
      for (const float v : {sum.r, sum.g, sum.b}) {
        picture.rgb[at++] = level(scene.noise > 0.0F ? v + scene.noise * rng.gaussian() : v);
      }
    }
  }
  return picture;
}

Yuv420View WorkImage::view() {
  const int cw = (width + 1) / 2, ch = (height + 1) / 2;
  return {{y.data(), width, height, width}, {cb.data(), cw, ch, cw}, {cr.data(), cw, ch, cw}};
}

WorkImage work_image(const Picture& picture, int width, int height) {
  const auto chroma = static_cast<std::size_t>((width + 1) / 2) * static_cast<std::size_t>((height + 1) / 2);
  WorkImage image{width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width * height)),
                  std::vector<std::uint8_t>(chroma), std::vector<std::uint8_t>(chroma)};
  const auto storage = std::make_unique<SubsampleStorage<1280, 640>>();
  Subsampler subsampler(storage->memory());
  REQUIRE(subsampler.configure(picture.width, picture.height, width, height) == Status::ok);
  REQUIRE(subsampler.run(picture.view(), image.view()) == Status::ok);
  return image;
}

}  // namespace touchline::test
