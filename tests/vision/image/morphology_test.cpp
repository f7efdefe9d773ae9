// SPDX-License-Identifier: Apache-2.0
// Erosion and dilation against the definition, pixel by pixel.
#include "vision/image/morphology.h"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

/// True when any (all) pixels of the square that are inside the image have `value`.
bool any_in_square(ConstBitView image, int cx, int cy, int radius, bool value) {
  for (int y = std::max(0, cy - radius); y <= std::min(image.height - 1, cy + radius); ++y) {
    for (int x = std::max(0, cx - radius); x <= std::min(image.width - 1, cx + radius); ++x) {
      if (image.get(x, y) == value) return true;
    }
  }
  return false;
}

}  // namespace

TEST_CASE("dilation grows a pixel to the kernel's square, cut off at the border") {
  Bits image = bits({"#.......", "........", "....#...", "........", "........"});
  dilate(image.view(), 3);
  CHECK(ascii(image) == ascii(bits({"##......", "##.###..", "...###..", "...###..", "........"})));
}

TEST_CASE("erosion takes a square's rim and leaves what touches the border") {
  Bits image = bits({"###.....", "###.....", "....###.", "....###.", "....###."});
  erode(image.view(), 3);
  CHECK(ascii(image) == ascii(bits({"##......", "........", "........", ".....#..", ".....#.."})));
}

TEST_CASE("kernel 1 changes nothing") {
  const Bits image = random_bits(70, 9, 50, 1);
  Bits changed = image;
  dilate(changed.view(), 1);
  erode(changed.view(), 1);
  erode(changed.view(), 0);
  CHECK(changed == image);
}

TEST_CASE("both agree with the definition at every size and kernel") {
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int side : {3, 5, 7, 11}) {
      for (const int percent : {3, 50, 97}) {
        const Bits image = random_bits(w, h, percent, static_cast<unsigned>(w * 31 + h));
        for (const Kernels& kernels : all_tables()) {
          CAPTURE(kernels.name);
          Bits grown = image, shrunk = image;
          dilate(grown.view(), side, kernels.join_squares);
          erode(shrunk.view(), side, kernels.join_squares);
          for (int y = 0; y < h; ++y) {
            for (int x = 0; x < w; ++x) {
              REQUIRE(grown.view().get(x, y) == any_in_square(image.view(), x, y, side / 2, true));
              REQUIRE(shrunk.view().get(x, y) == !any_in_square(image.view(), x, y, side / 2, false));
            }
          }
          CHECK(padding_is_clear(grown.view()));
          CHECK(padding_is_clear(shrunk.view()));
        }
      }
    }
  }
}

TEST_CASE("a full image stays full, an empty one empty") {
  Bits full(320, 240), empty(320, 240);
  fill(full.view());
  erode(full.view(), 5);
  CHECK(count(full.view()) == 320 * 240);
  dilate(empty.view(), 5);
  CHECK(count(empty.view()) == 0);
}
