// SPDX-License-Identifier: Apache-2.0
// Rays of pixels, cell by cell, against those of their centres, one by one.
#include "vision/pixel_rays.h"

#include <doctest/doctest.h>

#include <vector>

using namespace touchline;

TEST_CASE("a pixel's ray is that of its centre, bit for bit, in any order, and outside the lens there is none") {
  constexpr int width = 100, height = 76;  // the last cells are cut
  Lens lens;
  LensParameters parameters{.model = LensModel::equidistant, .focal_px = 90.0F, .cx = 150.0F, .cy = 76.0F};
  parameters.max_theta = radians(80.0F);  // a circle that the picture's corners lie outside of
  REQUIRE(Lens::create(parameters, lens) == Status::ok);
  std::vector<Vec3> corners(static_cast<std::size_t>(ray_columns(width) * ray_rows(height)));
  const RayGridView grid{corners, ray_columns(width), ray_rows(height)};
  make_ray_grid(lens, 3 * width, 2 * height, width, height, grid);
  const GroundProjection projection(lens, {0.02F, -0.01F, 0.6F, 0.3F, 0.5F, -0.2F});
  const WorkRays rays(projection, grid, 3 * width, 2 * height, width, height);
  PixelRays pixels(rays);
  int seen = 0;
  for (int n = 0; n < width * height; ++n) {
    const int i = n * 37 % (width * height);  // cells in no order
    const GridPoint p{static_cast<std::int16_t>(i % width), static_cast<std::int16_t>(i / width)};
    Vec3 expected, ray;
    const bool has = rays.ray({static_cast<float>(p.x) + 0.5F, static_cast<float>(p.y) + 0.5F}, expected);
    REQUIRE(pixels.ray(p, ray) == has);
    if (!has) continue;
    REQUIRE(ray.x == expected.x);
    REQUIRE(ray.y == expected.y);
    REQUIRE(ray.z == expected.z);
    ++seen;
  }
  CHECK(seen > width * height / 2);
  CHECK(seen < width * height);
}

TEST_CASE("many ground points at once lie where each does in the working image, bit for bit") {
  Lens lens;
  LensParameters parameters{.model = LensModel::equidistant, .focal_px = 90.0F, .cx = 150.0F, .cy = 76.0F};
  parameters.max_theta = radians(80.0F);
  REQUIRE(Lens::create(parameters, lens) == Status::ok);
  const GroundProjection projection(lens, {0.02F, -0.01F, 0.6F, 0.3F, 0.5F, -0.2F});
  const WorkRays rays(projection, {}, 300, 152, 100, 76);
  int seen = 0, count = 0;
  for (int n = 0; n < 60; ++n) {
    RayLanes lanes;
    GroundPoint points[RayLanes::most];
    for (int i = 0; i <= n % RayLanes::most; ++i) {
      points[i] = {-2.0F + 0.1F * static_cast<float>(n), -1.5F + 0.2F * static_cast<float>(i)};
      lanes.add(points[i]);
    }
    rays.work_points(lanes);
    for (int i = 0; i < lanes.count; ++i, ++count) {
      WorkPoint expected;
      const bool sees = rays.work_point(points[i], 0.0F, expected);
      REQUIRE((lanes.seen[i] == 1) == sees);
      if (!sees) continue;
      REQUIRE(lanes.u[i] == expected.u);
      REQUIRE(lanes.v[i] == expected.v);
      ++seen;
    }
  }
  CHECK(seen > count / 4);
  CHECK(seen < count);
}
