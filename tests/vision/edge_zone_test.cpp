// SPDX-License-Identifier: Apache-2.0
// Where edges are looked for: against the definition, pixel by pixel, and on pictures that a person can read.
#include "vision/edge_zone.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "platform/core/rng.h"
#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"
#include "vision/line_extent.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Scene {
  int w, h;
  Bits white, green, region, lines;
  std::vector<LineWidth> widths;

  Scene(int width, int height)
      : w(width),
        h(height),
        white(w, h),
        green(w, h),
        region(w, h),
        lines(w, h),
        widths(static_cast<std::size_t>(columns() * ((h + width_block_px - 1) / width_block_px))) {}
  [[nodiscard]] int columns() const { return (w + width_block_px - 1) / width_block_px; }
  [[nodiscard]] EdgeZoneInput input() const {
    return {white.view(),
            green.view(),
            region.view(),
            lines.view(),
            {widths.data(), columns(), static_cast<int>(widths.size()) / columns(), columns()}};
  }

  [[nodiscard]] bool open(int x, int y) const {
    for (int v = y - 1; v <= y + 1; ++v) {
      for (int u = x - 1; u <= x + 1; ++u) {
        if (lines.view().get(u, v)) return false;
      }
    }
    return white.view().get(x, y) && region.view().get(x, y);
  }
  [[nodiscard]] int reach(int x, int y) const {
    int longest = 0;
    for (int u = x / 64 * 64; u < std::min(x / 64 * 64 + 64, w); ++u) {
      if (open(u, y)) longest = std::max(longest, longest_step(width_at(input().widths, u, y)));
    }
    return longest;
  }
  [[nodiscard]] bool carpet_towards(int x, int y, int dx, int dy, int reach) const {
    for (int k = 1; k <= reach; ++k) {
      const int u = x + k * dx, v = y + k * dy;
      if (green.view().get(u, v) && !white.view().get(u, v)) return true;
    }
    return false;
  }
  [[nodiscard]] bool seed(int x, int y) const {
    if (!open(x, y)) return false;
    const int r = reach(x, y);
    if (r >= 64) return true;
    const auto carpet = [&](int dx, int dy) { return carpet_towards(x, y, dx, dy, r); };
    return (carpet(-1, 0) && carpet(1, 0)) || (carpet(0, -1) && carpet(0, 1));
  }
  [[nodiscard]] Bits expected() const {
    Bits zone(w, h);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        if (!seed(x, y)) continue;
        for (int v = std::max(y - 4, 0); v <= std::min(y + 4, h - 1); ++v) {
          for (int u = std::max(x - 4, 0); u <= std::min(x + 4, w - 1); ++u) {
            zone.view().set(u, v, region.view().get(u, v));
          }
        }
      }
    }
    return zone;
  }
};

Bits zone_of(const Scene& scene) {
  Bits zone(scene.w, scene.h);
  fill(zone.view());  // nothing of it stays
  find_edge_zone(scene.input(), zone.view());
  return zone;
}

/// One letter a pixel: # green carpet, o white, . neither. The table is empty: carpet may be five pixels away.
Scene drawn(const std::vector<std::string>& rows) {
  Scene scene(static_cast<int>(rows[0].size()), static_cast<int>(rows.size()));
  for (int y = 0; y < scene.h; ++y) {
    for (int x = 0; x < scene.w; ++x) {
      const char letter = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
      scene.green.view().set(x, y, letter == '#');
      scene.white.view().set(x, y, letter == 'o');
    }
  }
  fill(scene.region.view());
  return scene;
}

}  // namespace

TEST_CASE("the zone is what its definition says, whatever the reach") {
  Rng rng(5);
  for (const auto& [w, h] : {std::pair{150, 43}, {64, 8}, {65, 17}, {7, 3}, {320, 90}, {577, 60}}) {
    // Widest line in 1/16 pixel, and how much carpet: little, so that far carpet decides, too.
    for (const auto& [narrowest, widest, carpet] :
         {std::tuple{0, 8, 12}, {0, 200, 12}, {350, 700, 1}, {600, 720, 1}, {0, 1200, 12}}) {
      const int width_px = w, widest_line = widest;  // clang lets no binding be captured
      CAPTURE(width_px);
      CAPTURE(widest_line);
      Scene scene(w, h);
      scene.white = random_bits(w, h, 3, 1);
      scene.green = random_bits(w, h, carpet, 4);
      scene.region = random_bits(w, h, 70, 2);
      scene.lines = random_bits(w, h, 2, 3);
      for (LineWidth& width : scene.widths) {
        const std::uint32_t more = rng.below(static_cast<std::uint32_t>(widest - narrowest));
        width.slanted = static_cast<std::uint16_t>(static_cast<std::uint32_t>(narrowest) + more);
      }
      const Bits expected = scene.expected();
      if (w > 100) CHECK(count(expected.view()) > 0);
      const Bits zone = zone_of(scene);
      CHECK(zone == expected);
      CHECK(padding_is_clear(zone.view()));
    }
  }
}

TEST_CASE("white with carpet on both sides is looked at, floor beside the carpet is not") {
  const Scene line = drawn({"##############", "##############", "ooo.oooooooooo", "##############", "##############"});
  CHECK(count(zone_of(line).view()) == line.w * line.h);
  const Scene floor = drawn({"##############", "##############", "oooooooooooooo", "oooooooooooooo", ".............."});
  CHECK(count(zone_of(floor).view()) == 0);
}

TEST_CASE("carpet that is white too ends nothing") {
  Scene scene = drawn({"#o#"});
  CHECK(count(zone_of(scene).view()) == 3);
  scene.white.view().set(2, 0, true);
  CHECK(count(zone_of(scene).view()) == 0);
}

TEST_CASE("carpet farther away than a line's width does not count") {
  // 2 pixels of tolerance and 3 of blur.
  CHECK(count(zone_of(drawn({"#....o....#"})).view()) == 9);
  CHECK(count(zone_of(drawn({"#....o.....#"})).view()) == 0);
}
