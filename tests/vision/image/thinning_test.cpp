// SPDX-License-Identifier: Apache-2.0
// The fast Zhang-Suen against a plain one, written as the publication words it.
#include "vision/image/thinning.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "tests/support/thinning_memory.h"
#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

using namespace touchline;
using namespace touchline::test;

namespace {

/// One pass of the textbook: looks at all pixels, then deletes. True when something was deleted.
bool plain_pass(Bits& image, bool second) {
  const Bits before = image;
  const ConstBitView p = before.view();
  for (int y = 0; y < p.height; ++y) {
    for (int x = 0; x < p.width; ++x) {
      if (!p.get(x, y)) continue;
      const bool n[8] = {p.get(x, y - 1), p.get(x + 1, y - 1), p.get(x + 1, y), p.get(x + 1, y + 1),
                         p.get(x, y + 1), p.get(x - 1, y + 1), p.get(x - 1, y), p.get(x - 1, y - 1)};
      int neighbours = 0, transitions = 0;
      for (int i = 0; i < 8; ++i) {
        neighbours += n[i] ? 1 : 0;
        transitions += !n[i] && n[(i + 1) % 8] ? 1 : 0;
      }
      const bool p2 = n[0], p4 = n[2], p6 = n[4], p8 = n[6];
      const bool sides = second ? !(p2 && p4 && p8) && !(p2 && p6 && p8) : !(p2 && p4 && p6) && !(p4 && p6 && p8);
      if (neighbours >= 2 && neighbours <= 6 && transitions == 1 && sides) image.view().set(x, y, false);
    }
  }
  return !(before == image);
}

Bits plain_thin(Bits image) {
  for (bool changed = true; changed;) {
    const bool first = plain_pass(image, false);
    const bool second = plain_pass(image, true);
    changed = first || second;
  }
  return image;
}

Bits fast_thin(Bits image) {
  OwnThinningMemory thinning(image.width, image.height);
  const Bits before = image;
  CHECK(thin(image.view(), thinning.memory()).finished);
  for (const Kernels& kernels : test::runnable_tables()) {
    Bits by_kernel = before;
    CHECK(thin(by_kernel.view(), thinning.memory(), kernels.thin).finished);
    CHECK(by_kernel == image);
  }
  return image;
}

void draw_line(Bits& image, double x0, double y0, double x1, double y1, double width) {
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double dx = x1 - x0, dy = y1 - y0, px = x - x0, py = y - y0;
      const double t = std::clamp((px * dx + py * dy) / (dx * dx + dy * dy), 0.0, 1.0);
      const double ex = px - t * dx, ey = py - t * dy;
      if (4 * (ex * ex + ey * ey) <= width * width) image.view().set(x, y, true);
    }
  }
}

/// Number of 8-connected components, by a flood with an explicit list.
int components(Bits image) {
  int found = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (!image.view().get(x, y)) continue;
      ++found;
      std::vector<std::pair<int, int>> open = {{x, y}};
      while (!open.empty()) {
        const auto [cx, cy] = open.back();
        open.pop_back();
        if (!image.view().get(cx, cy)) continue;
        image.view().set(cx, cy, false);
        for (int d = 0; d < 9; ++d) open.emplace_back(cx + d % 3 - 1, cy + d / 3 - 1);
      }
    }
  }
  return found;
}

}  // namespace

TEST_CASE("random masks of many densities and sizes thin as the textbook thins them") {
  unsigned seed = 0;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {5, 20, 40, 60, 80, 90, 97, 100}) {
      const Bits image = random_bits(w, h, percent, ++seed);
      const Bits thinned = fast_thin(image);
      REQUIRE(ascii(thinned) == ascii(plain_thin(image)));
      REQUIRE(padding_is_clear(thinned.view()));
    }
  }
}

TEST_CASE("random blobs thin as the textbook thins them") {
  for (unsigned seed = 0; seed < 30; ++seed) {
    Bits image = random_bits(190 + static_cast<int>(seed), 60, 2 + static_cast<int>(seed % 5), seed);
    dilate(image.view(), 3 + 2 * static_cast<int>(seed % 3));
    REQUIRE(ascii(fast_thin(image)) == ascii(plain_thin(image)));
  }
}

TEST_CASE("drawn lines thin as the textbook thins them, stay in one piece, and a second thinning changes nothing") {
  std::mt19937 random(7);
  for (int round = 0; round < 60; ++round) {
    Bits image(160, 120);
    const auto coordinate = [&](int n) { return static_cast<double>(random() % static_cast<unsigned>(n)); };
    const double width = 3.0 + static_cast<double>(random() % 50) / 10.0;
    const double x = coordinate(160), y = coordinate(120);
    for (int i = 0; i < 4; ++i) draw_line(image, x, y, coordinate(160), coordinate(120) + 0.5, width);
    const Bits thinned = fast_thin(image);
    REQUIRE(ascii(thinned) == ascii(plain_thin(image)));
    CHECK(components(image) == 1);
    CHECK(components(thinned) == 1);
    CHECK(fast_thin(thinned) == thinned);
    Bits thick = thinned;
    erode(thick.view(), 3);
    CHECK(count(thick.view()) == 0);
  }
}

TEST_CASE("a horizontal bar becomes its middle row") {
  CHECK(ascii(fast_thin(bits({".........", ".#######.", ".#######.", ".#######.", "........."}))) ==
        ascii(bits({".........", ".........", "..####...", ".........", "........."})));
}

TEST_CASE("known loss: a 2x2 block vanishes") {
  const Bits block = bits({"....", ".##.", ".##.", "...."});
  CHECK(count(fast_thin(block).view()) == 0);
  CHECK(count(plain_thin(block).view()) == 0);
}

TEST_CASE("known loss: nearly all of a diagonal two pixels wide vanishes") {
  Bits diagonal(60, 60);
  for (int i = 0; i < 50; ++i) set_span(diagonal.view(), 5 + i, 4 + i, 5 + i, true);
  const Bits thinned = fast_thin(diagonal);
  CHECK(ascii(thinned) == ascii(plain_thin(diagonal)));
  CHECK(count(thinned.view()) <= 2);
}

TEST_CASE("the worst image ends within the bound") {
  Bits full(320, 240);
  fill(full.view());
  OwnThinningMemory thinning(320, 240);
  const ThinningResult result = thin(full.view(), thinning.memory());
  CHECK(result.finished);
  CHECK(result.iterations <= 122);
}
