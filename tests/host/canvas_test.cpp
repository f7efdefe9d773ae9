// SPDX-License-Identifier: Apache-2.0
// Drawing stays inside the picture and puts colour where it was asked to.
#include "platform/host/canvas.h"

#include <limits>

#include <doctest/doctest.h>

namespace touchline::host {
namespace {

bool is(const Canvas& canvas, int x, int y, Colour colour) {
  const auto* p = canvas.image().at(x, y);
  return p[0] == colour.r && p[1] == colour.g && p[2] == colour.b;
}
int count(const Canvas& canvas, Colour colour) {
  int n = 0;
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) n += is(canvas, x, y, colour) ? 1 : 0;
  }
  return n;
}

TEST_CASE("a line is connected from end to end, also when its ends are far outside") {
  Canvas canvas(20, 10, colours::black);
  canvas.line({0.5F, 5.5F}, {19.5F, 5.5F}, colours::red);
  CHECK(count(canvas, colours::red) == 20);
  CHECK(is(canvas, 0, 5, colours::red));
  CHECK(is(canvas, 19, 5, colours::red));
  canvas.line({-1e8F, 2.5F}, {1e8F, 2.5F}, colours::green);
  CHECK(count(canvas, colours::green) == 20);
  canvas.line({-50.0F, -50.0F}, {-10.0F, 80.0F}, colours::blue);
  CHECK(count(canvas, colours::blue) == 0);
  canvas.line({0.0F, 0.0F}, {std::numeric_limits<float>::quiet_NaN(), 3.0F}, colours::blue);
  CHECK(count(canvas, colours::blue) == 0);
}

TEST_CASE("discs and rectangles are cut off at the edge") {
  Canvas canvas(8, 8, colours::black);
  canvas.disc({0.0F, 0.0F}, 2.0F, colours::red);
  CHECK(count(canvas, colours::red) == 3);
  canvas.rectangle(6, 6, 100, 100, colours::blue);
  CHECK(count(canvas, colours::blue) == 4);
}

TEST_CASE("text has the width that is told, and different words look different") {
  Canvas a(100, 14, colours::black);
  a.text(1, 1, "pose 1.25", colours::white);
  CHECK(count(a, colours::white) > 40);
  for (int y = 0; y < 14; ++y) CHECK(is(a, 2 + Canvas::text_width("pose 1.25"), y, colours::black));
  Canvas b(100, 14, colours::black);
  b.text(1, 1, "pose 1.26", colours::white);
  CHECK(a.image().rgb != b.image().rgb);
}

TEST_CASE("a pasted picture keeps its pixels, enlarged by the factor") {
  RgbImage small(2, 1);
  small.at(1, 0)[0] = 255;
  Canvas canvas(10, 10, colours::black);
  canvas.paste(small, 3, 4, 2);
  CHECK(count(canvas, {255, 0, 0}) == 4);
  CHECK(is(canvas, 5, 4, {255, 0, 0}));
  CHECK(is(canvas, 4, 4, colours::black));
}

}  // namespace
}  // namespace touchline::host
