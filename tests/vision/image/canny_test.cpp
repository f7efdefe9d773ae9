// SPDX-License-Identifier: Apache-2.0
// Canny against a plain implementation with whole images and a flood, and against what edges are.
#include "vision/image/canny.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Plain {
  int w, h;
  std::vector<int> values;
  Plain(int width, int height)
      : w(width), h(height), values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {}
  int& at(int x, int y) { return values[static_cast<std::size_t>(y * w + x)]; }
  /// The border repeats.
  int near(int x, int y) { return at(std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1)); }
  /// Nothing beyond the border.
  int or_zero(int x, int y) { return x < 0 || y < 0 || x >= w || y >= h ? 0 : at(x, y); }
};

using Kernel = int[9];
Plain filter(Plain& image, const Kernel& kernel) {
  Plain out(image.w, image.h);
  for (int y = 0; y < image.h; ++y) {
    for (int x = 0; x < image.w; ++x) {
      for (int k = 0; k < 9; ++k) out.at(x, y) += kernel[k] * image.near(x + k % 3 - 1, y + k / 3 - 1);
    }
  }
  return out;
}

Bits plain_edges(const Gray& gray, const Bits& roi, CannyThresholds t) {
  Plain image(gray.width, gray.height);
  for (int y = 0; y < gray.height; ++y) {
    for (int x = 0; x < gray.width; ++x) image.at(x, y) = gray.view().at(x, y);
  }
  Plain blurred = filter(image, Kernel{1, 2, 1, 2, 4, 2, 1, 2, 1});
  Plain gx = filter(blurred, Kernel{-1, 0, 1, -2, 0, 2, -1, 0, 1});
  Plain gy = filter(blurred, Kernel{-1, -2, -1, 0, 0, 0, 1, 2, 1});
  Plain m(gray.width, gray.height);
  for (std::size_t i = 0; i < m.values.size(); ++i) {
    const int ax = std::abs(gx.values[i]), ay = std::abs(gy.values[i]);
    m.values[i] = std::max(ax, ay) + std::min(ax, ay) * 3 / 8;
  }
  Bits weak(gray.width, gray.height), edges(gray.width, gray.height);
  std::vector<std::pair<int, int>> open;
  for (int y = 0; y < gray.height; ++y) {
    for (int x = 0; x < gray.width; ++x) {
      if (!roi.view().get(x, y) || m.at(x, y) < 16 * t.low) continue;
      const int dx = gx.at(x, y), dy = gy.at(x, y), sx = dx < 0 ? -1 : 1, sy = dy < 0 ? -1 : 1;
      const bool along_x = std::abs(dx) >= std::abs(dy);
      const std::int64_t most = std::max(std::abs(dx), std::abs(dy)), least = std::min(std::abs(dx), std::abs(dy));
      const auto along = [&](int sign) {
        const int side = along_x ? m.or_zero(x + sign * sx, y) : m.or_zero(x, y + sign * sy);
        return side * (most - least) + m.or_zero(x + sign * sx, y + sign * sy) * least;
      };
      if (m.at(x, y) * most <= along(1) || m.at(x, y) * most < along(-1)) continue;
      weak.view().set(x, y, true);
      if (m.at(x, y) >= 16 * t.high) open.emplace_back(x, y);
    }
  }
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (!weak.view().get(x, y) || edges.view().get(x, y)) continue;
    edges.view().set(x, y, true);
    for (int d = 0; d < 9; ++d) open.emplace_back(x + d % 3 - 1, y + d / 3 - 1);
  }
  return edges;
}

Bits edges_of(const Gray& gray, const Bits& roi, CannyThresholds t) {
  std::vector<std::uint16_t> rows(static_cast<std::size_t>(canny_rows * canny_row_stride(gray.width)), 0xABCD);
  Bits weak(gray.width, gray.height), edges(gray.width, gray.height);
  CHECK(find_edges(gray.view(), roi.view(), t, {rows}, weak.view(), edges.view()).finished);
  CHECK(padding_is_clear(edges.view()));
  // With each table of kernels, and without vector registers, the same is seen.
  const Bits weak_here = weak;
  for (const Kernels& kernels : test::runnable_tables()) {
    Bits by_kernels(gray.width, gray.height);
    CHECK(find_edges(gray.view(), roi.view(), t, {rows}, weak.view(), by_kernels.view(), kernels).finished);
    REQUIRE(by_kernels == edges);
    REQUIRE(weak == weak_here);
  }
  Bits by_words(gray.width, gray.height);
  CHECK(find_edges_by_words(gray.view(), roi.view(), t, {rows}, weak.view(), by_words.view()).finished);
  REQUIRE(by_words == edges);
  REQUIRE(weak == weak_here);
  return edges;
}

Bits whole(const Gray& gray) {
  Bits roi(gray.width, gray.height);
  fill(roi.view());
  return roi;
}

/// Smooth hills with noise on them: gradients of all directions.
Gray hills(int w, int h, unsigned seed, int noise) {
  std::mt19937 random(seed);
  Gray image(w, h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      const double value = 128 + 90 * std::sin(0.21 * x + 0.1 * seed) * std::cos(0.17 * y - 0.05 * x) +
                           (static_cast<int>(random() % 1000) - 500) * noise / 500.0;
      image.view().at(x, y) = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
    }
  }
  return image;
}

}  // namespace

TEST_CASE("edges are those of the plain implementation: every size, hills and noise, any region") {
  unsigned seed = 0;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int noise : {0, 20, 400}) {
      const Gray gray = hills(w, h * 4, ++seed, noise);
      REQUIRE(ascii(edges_of(gray, whole(gray), {40, 90})) == ascii(plain_edges(gray, whole(gray), {40, 90})));
      Bits roi(w, h * 4);
      for (int y = h; y < 3 * h; ++y) set_span(roi.view(), y, w / 3, w - w / 4 - y % 5, true);
      REQUIRE(ascii(edges_of(gray, roi, {20, 200})) == ascii(plain_edges(gray, roi, {20, 200})));
      const Bits specks = random_bits(w, h * 4, 30, seed);
      REQUIRE(ascii(edges_of(gray, specks, {30, 60})) == ascii(plain_edges(gray, specks, {30, 60})));
    }
  }
}

TEST_CASE("a region's first and last column are compared with their neighbours outside it, wherever words begin") {
  const Gray gray = hills(200, 40, 77, 200);
  for (int first = 60; first <= 132; ++first) {
    Bits roi(gray.width, gray.height);
    for (int y = 5; y < 35; ++y) set_span(roi.view(), y, first, first + 3 + first % 5, true);
    REQUIRE(ascii(edges_of(gray, roi, {20, 40})) == ascii(plain_edges(gray, roi, {20, 40})));
  }
}

TEST_CASE("extremes of gray do not overflow") {
  std::mt19937 random(3);
  Gray gray(100, 60);
  for (std::uint8_t& v : gray.samples) v = random() % 2 == 0 ? 0 : 255;
  CHECK(edges_of(gray, whole(gray), {100, 300}) == plain_edges(gray, whole(gray), {100, 300}));
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 60; ++y) gray.view().at(x, y) = x + y < 80 ? 0 : 255;
  }
  CHECK(edges_of(gray, whole(gray), {1, 1400}) == plain_edges(gray, whole(gray), {1, 1400}));
}

TEST_CASE("a bright bar has one thin edge on either side, and a flat image none") {
  const Gray bar = gray({"000099990000", "000099990000", "000099990000", "000099990000", "000099990000"}, 20);
  const Bits edges = edges_of(bar, whole(bar), {40, 90});
  for (int y = 0; y < 5; ++y) {
    int found = 0;
    for (int x = 0; x < 12; ++x) found += edges.view().get(x, y) ? 1 : 0;
    CHECK(found == 2);
    CHECK((edges.view().get(3, y) || edges.view().get(4, y)));
    CHECK((edges.view().get(7, y) || edges.view().get(8, y)));
  }
  CHECK(count(edges_of(Gray(70, 9, 200), whole(Gray(70, 9)), {1, 1}).view()) == 0);
}

TEST_CASE("a circle's edge is a closed curve one pixel thin at every angle") {
  Gray disc(120, 120);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 120; ++x) {
      const double r = std::hypot(x - 60.2, y - 59.7);
      disc.view().at(x, y) = static_cast<std::uint8_t>(std::clamp(60 + 100 * (40.5 - r), 60.0, 160.0));
    }
  }
  const Bits edges = edges_of(disc, whole(disc), {60, 120});
  int sectors[72] = {};
  for_each_set_bit(edges.view(), [&](int x, int y) {
    CHECK(std::abs(std::hypot(x - 60.2, y - 59.7) - 40) < 1.2);
    ++sectors[static_cast<int>((std::atan2(y - 59.7, x - 60.2) + 3.14159266) / 6.2832 * 72)];
  });
  for (const int pixels : sectors) {
    CHECK(pixels >= 2);  // 3.5 pixels of arc a sector
    CHECK(pixels <= 6);
  }
}

TEST_CASE("a ramp's slope and a step's height have the documented magnitudes") {
  Gray ramp(64, 9), step(64, 9);
  for (int y = 0; y < 9; ++y) {
    for (int x = 0; x < 64; ++x) {
      ramp.view().at(x, y) = static_cast<std::uint8_t>(x < 30 ? 0 : std::min(3 * (x - 30), 60));
      step.view().at(x, y) = x < 30 ? 20 : 70;
    }
  }
  CHECK(count(edges_of(step, whole(step), {150, 150}).view()) == 9);
  CHECK(count(edges_of(step, whole(step), {151, 151}).view()) == 0);
  CHECK(count(edges_of(ramp, whole(ramp), {24, 24}).view()) > 0);
  CHECK(count(edges_of(ramp, whole(ramp), {25, 25}).view()) == 0);
}

TEST_CASE("a weak edge stays where a strong one leads to it, and goes where none does") {
  Gray image(90, 12);
  for (int y = 0; y < 12; ++y) {
    for (int x = 0; x < 90; ++x) {
      const int step = x < 40 ? 60 : x < 60 ? 30 : x < 70 ? 0 : 30;
      image.view().at(x, y) = static_cast<std::uint8_t>(y < 6 ? 50 : 50 + step);
    }
  }
  const Bits edges = edges_of(image, whole(image), {60, 150});
  const auto has_edge = [&](int x) {
    bool any = false;
    for (int y = 0; y < 12; ++y) any = any || edges.view().get(x, y);
    return any;
  };
  CHECK(has_edge(20));
  CHECK(has_edge(50));
  CHECK_FALSE(has_edge(65));
  CHECK_FALSE(has_edge(80));
}
