// SPDX-License-Identifier: Apache-2.0
// The mask against the projection asked pixel by pixel.
#include "vision/ground_mask.h"

#include <doctest/doctest.h>

#include <array>

#include "tests/support/ascii_image.h"
#include "tests/support/paper_lens.h"
#include "tests/vision/painted_field.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

constexpr int w = 320, h = 240;

struct Grid {
  std::array<Vec3, static_cast<std::size_t>(ray_columns(w) * ray_rows(h))> rays{};
  Bits seen{w, h};
  RayGridView view() { return {rays, ray_columns(w), ray_rows(h)}; }
};

bool sees_ground(const GroundProjection& projection, int x, int y, float range) {
  GroundPoint g;
  const PixelPoint pixel{(static_cast<float>(x) + 0.5F) * 2.35F, (static_cast<float>(y) + 0.5F) * 2.0F};
  return projection.ground(pixel, g) && math::hypot(g.x, g.y) < range;
}

}  // namespace

TEST_CASE("the mask agrees with the projection but for pixels on its border") {
  Grid grid;
  make_ray_grid(test::paper_lens(), 752, 480, w, h, grid.view());
  make_seen_mask(test::paper_lens(), 752, 480, {}, grid.seen.view());
  for (const float roll : {0.0F, 0.4F, -1.2F}) {
    CameraPose pose = usual_pose();
    pose.roll = roll;
    const GroundProjection projection(test::paper_lens(), pose);
    Bits ground(w, h);
    make_ground_mask(grid.view(), pose, 5.0F, grid.seen.view(), ground.view());
    int wrong = 0;
    for (int y = 1; y + 1 < h; ++y) {
      for (int x = 1; x + 1 < w; ++x) {
        const bool here = sees_ground(projection, x, y, 5.0F);
        if (here == ground.view().get(x, y)) continue;
        bool border = false;
        for (const int d : {-1, 1}) {
          border = border || sees_ground(projection, x + d, y, 5.0F) != here ||
                   sees_ground(projection, x, y + d, 5.0F) != here;
        }
        if (!border) ++wrong;
      }
    }
    CHECK(wrong == 0);
    CHECK(count(ground.view()) > w * h / 4);
    CHECK(padding_is_clear(ground.view()));
  }
}

TEST_CASE("the robot's own body is left out") {
  std::array<MaskPolygon, 1> body;
  for (const PixelPoint p : {PixelPoint{300, 400}, PixelPoint{450, 400}, PixelPoint{450, 480}, PixelPoint{300, 480}}) {
    REQUIRE(body[0].push_back(p));
  }
  Bits seen(w, h);
  make_seen_mask(test::paper_lens(), 752, 480, body, seen.view());
  CHECK_FALSE(seen.view().get(160, 220));
  CHECK(seen.view().get(120, 220));
  CHECK(seen.view().get(160, 190));
  CHECK_FALSE(seen.view().get(2, 2));  // outside the image circle
}
