// SPDX-License-Identifier: Apache-2.0
// Hulls against the definition: no point lies outside, every corner is a point and turns, and the fill is the pixels
// inside.
#include "vision/image/hull.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

int cross(GridPoint o, GridPoint a, GridPoint b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

/// Inside or on the border of a hull given clockwise on the screen.
bool inside(const std::vector<GridPoint>& hull, GridPoint p) {
  if (hull.size() == 1) return hull[0] == p;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const GridPoint a = hull[i], b = hull[(i + 1) % hull.size()];
    if (cross(a, b, p) < 0) return false;
    if (hull.size() == 2 && (p.x < std::min(a.x, b.x) || p.x > std::max(a.x, b.x) || p.y < std::min(a.y, b.y) ||
                             p.y > std::max(a.y, b.y))) {
      return false;
    }
  }
  return true;
}

std::vector<GridPoint> hull_of(const Bits& mask) {
  std::vector<GridPoint> scratch(static_cast<std::size_t>(max_hull_points(mask.height)) + 1), hull(scratch.size());
  hull.resize(static_cast<std::size_t>(hull_of_mask(mask.view(), scratch, hull)));
  return hull;
}

}  // namespace

TEST_CASE("the hull of a mask encloses it, turns at every corner, and fills to the pixels inside") {
  unsigned seed = 0;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {0, 1, 5, 50, 100}) {
      for (int round = 0; round < 4; ++round) {
        const Bits mask = random_bits(w, h, percent, ++seed);
        const std::vector<GridPoint> hull = hull_of(mask);
        REQUIRE(hull.empty() == (count(mask.view()) == 0));
        Bits filled(w, h), expected(w, h);
        fill_hull(filled.view(), hull);
        for (int y = 0; y < h; ++y) {
          for (int x = 0; x < w; ++x) {
            const GridPoint p = {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
            const bool in = !hull.empty() && inside(hull, p);
            if (mask.view().get(x, y)) REQUIRE(in);
            expected.view().set(x, y, in);
          }
        }
        REQUIRE(ascii(filled) == ascii(expected));
        for (std::size_t i = 0; hull.size() > 2 && i < hull.size(); ++i) {
          CHECK(cross(hull[i], hull[(i + 1) % hull.size()], hull[(i + 2) % hull.size()]) > 0);
        }
        for (const GridPoint corner : hull) CHECK(mask.view().get(corner.x, corner.y));
        // The same from its points in any order, some of them twice.
        std::vector<GridPoint> points;
        for_each_set_bit(mask.view(), [&](int x, int y) {
          points.insert(points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2),
                        {static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)});
          if (x % 3 == 0) points.push_back(points[0]);
        });
        std::vector<GridPoint> again(static_cast<std::size_t>(max_hull_points(h)) + 1);
        again.resize(static_cast<std::size_t>(hull_of_points(points, again)));
        CHECK(again == hull);
      }
    }
  }
}

TEST_CASE("a hull begins at its top left corner and goes clockwise") {
  CHECK(hull_of(bits({".....", ".###.", ".#.#.", ".####"})) == std::vector<GridPoint>{{1, 1}, {3, 1}, {4, 3}, {1, 3}});
}

TEST_CASE("a hull that reaches outside the image is cut off there") {
  Bits image(6, 4);
  const std::vector<GridPoint> hull = {{-5, -5}, {20, -5}, {20, 1}, {-5, 1}};
  fill_hull(image.view(), hull);
  CHECK(ascii(image) == ascii(bits({"######", "######", "......", "......"})));
}
