// SPDX-License-Identifier: Apache-2.0
// Whole-mask operations against pixel by pixel loops, and polygon fill against a point-in-polygon test.
#include "vision/image/bit_ops.h"

#include <doctest/doctest.h>

#include <bit>
#include <random>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"

using namespace touchline;
using namespace touchline::test;

TEST_CASE("logic of two masks is the logic of their pixels, and the padding stays clear") {
  for (const auto& [w, h] : awkward_sizes()) {
    const Bits a = random_bits(w, h, 50, 1);
    const Bits b = random_bits(w, h, 50, 2);
    Bits both = a, either = a, only = a, inverse = a, full = a, none = a, copied(w, h);
    and_with(both.view(), b.view());
    or_with(either.view(), b.view());
    and_not_with(only.view(), b.view());
    invert(inverse.view());
    fill(full.view());
    clear(none.view());
    copy(a.view(), copied.view());
    int set = 0;
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        const bool in_a = a.view().get(x, y), in_b = b.view().get(x, y);
        REQUIRE(both.view().get(x, y) == (in_a && in_b));
        REQUIRE(either.view().get(x, y) == (in_a || in_b));
        REQUIRE(only.view().get(x, y) == (in_a && !in_b));
        REQUIRE(inverse.view().get(x, y) == !in_a);
        set += in_a ? 1 : 0;
      }
    }
    CHECK(count(a.view()) == set);
    CHECK(count(full.view()) == w * h);
    CHECK(count(none.view()) == 0);
    for (const Kernels& kernels : test::all_tables()) {
      CAPTURE(kernels.name);
      CHECK(count(a.view(), kernels) == set);
      CHECK(count(full.view(), kernels) == w * h);
    }
    CHECK(equal(a.view(), copied.view()));
    CHECK(padding_is_clear(inverse.view()));
    CHECK(padding_is_clear(full.view()));
  }
}

TEST_CASE("equal sees one differing pixel and a differing size") {
  const Bits a = random_bits(65, 4, 50, 3);
  Bits b = a;
  b.view().set(64, 3, !b.view().get(64, 3));
  CHECK_FALSE(equal(a.view(), b.view()));
  CHECK_FALSE(equal(a.view(), Bits(65, 3).view()));
}

TEST_CASE("a rectangle is empty until one of its pixels is set, across word borders too") {
  constexpr int width = 200, height = 3;
  for (const auto& [first, last] : {std::pair{0, 0}, std::pair{5, 63}, std::pair{63, 64}, std::pair{10, 199}}) {
    for (int x = 0; x < width; ++x) {
      for (int y = 0; y < height; ++y) {
        Bits one(width, height);
        one.view().set(x, y, true);
        REQUIRE(any_set(one.view(), first, 1, last, 1) == (x >= first && x <= last && y == 1));
        REQUIRE(any_set(one.view(), first, 0, last, height - 1) == (x >= first && x <= last));
      }
    }
  }
}

TEST_CASE("set pixels are visited once each, in raster order") {
  const Bits image = random_bits(130, 6, 20, 4);
  Bits visited(130, 6);
  int last = -1;
  for_each_set_bit(image.view(), [&](int x, int y) {
    CHECK(y * 130 + x > last);
    last = y * 130 + x;
    visited.view().set(x, y, true);
  });
  CHECK(visited == image);
}

TEST_CASE("a span is set and cleared over word borders and clipped to the image") {
  Bits image(150, 2);
  set_span(image.view(), 0, 60, 130, true);
  CHECK(count(image.view()) == 71);
  CHECK(image.view().get(60, 0));
  CHECK(image.view().get(130, 0));
  set_span(image.view(), 0, 64, 127, false);
  CHECK(count(image.view()) == 7);
  set_span(image.view(), 1, -5, 900, true);
  CHECK(count(image.view()) == 157);
  set_span(image.view(), 2, 0, 9, true);
  set_span(image.view(), -1, 0, 9, true);
  set_span(image.view(), 0, 9, 8, true);
  CHECK(count(image.view()) == 157);
  CHECK(padding_is_clear(image.view()));
}

namespace {

/// Crossing number of a ray to the left, in doubles.
bool inside(const std::vector<SubpixelPoint>& polygon, double x, double y) {
  bool odd = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const SubpixelPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    if ((a.y <= y) == (b.y <= y)) continue;
    const double crossing = a.x + (y - a.y) * static_cast<double>(b.x - a.x) / (b.y - a.y);
    if (crossing <= x) odd = !odd;
  }
  return odd;
}

}  // namespace

TEST_CASE("a filled polygon holds the pixels whose centres are inside") {
  Bits image(8, 5);
  const std::vector<SubpixelPoint> square = {{16, 16}, {80, 16}, {80, 64}, {16, 64}};
  CHECK(fill_polygon(image.view(), square, true) == 0);
  CHECK(ascii(image) == ascii(bits({"........", ".####...", ".####...", ".####...", "........"})));
  fill_polygon(image.view(), square, false);
  CHECK(count(image.view()) == 0);
}

TEST_CASE("random polygons, also far outside the image, agree with a point-in-polygon test") {
  std::mt19937 random(5);
  for (int round = 0; round < 200; ++round) {
    std::vector<SubpixelPoint> polygon(3 + random() % 8);
    for (SubpixelPoint& p : polygon) {
      p = {static_cast<int>(random() % 3000) - 700, static_cast<int>(random() % 1400) - 400};
    }
    Bits image(100, 40);
    fill_polygon(image.view(), polygon, true);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 100; ++x) REQUIRE(image.view().get(x, y) == inside(polygon, 16 * x + 8, 16 * y + 8));
    }
  }
}

TEST_CASE("a polygon with too many points says so; nothing and one point fill nothing") {
  Bits image(20, 20);
  CHECK(fill_polygon(image.view(), std::vector<SubpixelPoint>(max_polygon_points + 3), true) == 3);
  CHECK(fill_polygon(image.view(), {}, true) == 0);
  CHECK(fill_polygon(image.view(), std::vector<SubpixelPoint>(1), true) == 0);
  CHECK(count(image.view()) == 0);
}

TEST_CASE("set bits are counted alike in both ways") {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const BitWord word = random() & random() >> (i % 64);
    CHECK(bits_set(word) == std::popcount(word));
    CHECK(bits_set_in_one(word) == std::popcount(word));
  }
  CHECK(bits_set(~BitWord{0}) == 64);
  CHECK(bits_set_in_one(~BitWord{0}) == 64);
}
