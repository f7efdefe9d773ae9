// SPDX-License-Identifier: Apache-2.0
// HSV against the definition in double precision by way of RGB, and the filter against the definition, for every colour
// there is.
#include "vision/image/hsv.h"

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

struct Exact {
  double hue, saturation, value, chroma;
};

Exact exact_hsv(int y, int cb, int cr) {
  const double r = y + 1.402 * (cr - 128), b = y + 1.772 * (cb - 128);
  const double g = (y - 0.299 * r - 0.114 * b) / 0.587;
  const double high = std::max({r, g, b}), chroma = high - std::min({r, g, b});
  Exact hsv = {0, 0, std::clamp(high, 0.0, 255.0), chroma};
  if (chroma < 1e-9) return hsv;
  hsv.saturation = high > 0 ? std::min(255.0, 255 * chroma / high) : 255;
  if (high == r)
    hsv.hue = 30 * (g - b) / chroma;
  else if (high == g)
    hsv.hue = 30 * (b - r) / chroma + 60;
  else
    hsv.hue = 30 * (r - g) / chroma + 120;
  if (hsv.hue < 0) hsv.hue += 180;
  return hsv;
}

}  // namespace

TEST_CASE("HSV is within rounding of the definition") {
  double worst_hue = 0, worst_saturation = 0, worst_value = 0;
  for (int y = 0; y < 256; y += 3) {
    for (int cb = 0; cb < 256; cb += 3) {
      for (int cr = 1; cr < 256; cr += 3) {
        const Exact expected = exact_hsv(y, cb, cr);
        const Hsv hsv =
            hsv_from_ycbcr(static_cast<std::uint8_t>(y), static_cast<std::uint8_t>(cb), static_cast<std::uint8_t>(cr));
        worst_value = std::max(worst_value, std::abs(hsv.value - expected.value));
        if (expected.value > 10)
          worst_saturation = std::max(worst_saturation, std::abs(hsv.saturation - expected.saturation));
        const double turn = std::abs(hsv.hue - expected.hue);
        worst_hue = std::max(worst_hue, std::min(turn, 180 - turn));
      }
    }
  }
  CHECK(worst_value < 0.8);       // half a step, and 0.4/256 of the chroma
  CHECK(worst_saturation < 4.0);  // at value 10 a step of rounding in the offsets is 25 times larger
  CHECK(worst_hue < 0.7);
}

TEST_CASE("known colours have their known hues") {
  // Y, Cb, Cr of pure red, green, blue, and gray.
  CHECK(hsv_from_ycbcr(76, 85, 255).hue == 0);
  CHECK(hsv_from_ycbcr(150, 44, 21).hue == 60);
  CHECK(hsv_from_ycbcr(29, 255, 107).hue == 120);
  CHECK(hsv_from_ycbcr(100, 128, 128) == Hsv{0, 0, 100});
  CHECK(hsv_from_ycbcr(150, 44, 21).saturation == 255);
  CHECK(hsv_from_ycbcr(150, 44, 21).value == 255);
}

TEST_CASE("the luma range of a chroma sample holds exactly the pixels that are in the HSV range") {
  std::mt19937 random(1);
  std::vector<HsvRange> ranges = {{},
                                  {35, 90, 50, 255, 20, 255},
                                  {18, 34, 110, 255, 60, 255},
                                  {170, 10, 1, 254, 1, 254},
                                  {0, 179, 0, 40, 150, 255},
                                  {90, 89, 10, 200, 0, 255},
                                  {0, 0, 0, 255, 0, 255}};
  for (int i = 0; i < 8; ++i) {
    const auto byte = [&] { return static_cast<std::uint8_t>(random()); };
    ranges.push_back({static_cast<std::uint8_t>(random() % 180), static_cast<std::uint8_t>(random() % 180), byte(),
                      byte(), byte(), byte()});
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    CAPTURE(i);
    const HsvFilter filter(ranges[i]);
    int wrong = 0;
    for (int cb = 0; cb < 256; ++cb) {
      for (int cr = static_cast<int>(i) % 2; cr < 256; cr += 2) {
        const auto b = static_cast<std::uint8_t>(cb), r = static_cast<std::uint8_t>(cr);
        const LumaBand luma = filter.luma_range(b, r);
        for (int y = 0; y < 256; y += (cb + cr) % 8 == 0 ? 1 : 17) {
          const bool expected = in_range(hsv_from_ycbcr(static_cast<std::uint8_t>(y), b, r), ranges[i]);
          wrong += expected != (y >= luma.low && y <= luma.high) ? 1 : 0;
        }
      }
    }
    CHECK(wrong == 0);
  }
}

void check_mask(const Kernels& kernels, const HsvRange& range) {
  std::mt19937 random(2);
  for (const auto& [w, h] : awkward_sizes()) {
    Gray y(w, h), cb((w + 1) / 2, (h + 1) / 2), cr((w + 1) / 2, (h + 1) / 2);
    for (Gray* plane : {&y, &cb, &cr}) {
      for (std::uint8_t& v : plane->samples) v = static_cast<std::uint8_t>(random());
    }
    Bits mask(w, h);
    Bits region(w, h);
    for (int v = 0; v < h; ++v) {
      for (int u = 0; u < w; ++u) region.view().set(u, v, (u / 64 + v / 3) % 2 == 0 && random() % 4 != 0);
    }
    hsv_in_range({y.view(), cb.view(), cr.view()}, range, region.view(), mask.view(), kernels);
    std::vector<Hsv> row(static_cast<std::size_t>(w));
    for (int v = 0; v < h; ++v) {
      hsv_row(y.view().row(v), cb.view().row(v / 2), cr.view().row(v / 2), w, row.data());
      for (int u = 0; u < w; ++u) {
        REQUIRE(mask.view().get(u, v) ==
                (region.view().get(u, v) && in_range(row[static_cast<std::size_t>(u)], range)));
      }
    }
    CHECK(padding_is_clear(mask.view()));
  }
}

TEST_CASE("the mask is the filter inside the region, pixel by pixel, at every size, with every table of kernels") {
  for (const HsvRange& range : {HsvRange{20, 110, 40, 255, 30, 240},
                                {0, 179, 0, 255, 40, 200},
                                {150, 70, 0, 90, 0, 255},
                                {50, 51, 9, 200},
                                {28, 95, 40, 255, 12, 255},
                                {170, 10, 1, 255, 0, 130},
                                {100, 160, 255, 255, 255, 255}}) {
    for (const Kernels& kernels : test::all_tables()) check_mask(kernels, range);
  }
}

TEST_CASE("a picture of one colour passes or not as a whole, with every table of kernels") {
  const HsvRange range = {18, 34, 110, 255, 60, 255};
  Gray y(128, 2, 150), cb(64, 1), cr(64, 1);
  Bits region(128, 2), mask(128, 2);
  fill(region.view());
  for (int c = 0; c < 256 * 256; c += 37) {
    const auto b = static_cast<std::uint8_t>(c / 256), r = static_cast<std::uint8_t>(c % 256);
    std::fill(cb.samples.begin(), cb.samples.end(), b);
    std::fill(cr.samples.begin(), cr.samples.end(), r);
    const int expected = in_range(hsv_from_ycbcr(150, b, r), range) ? 256 : 0;
    for (const Kernels& kernels : test::all_tables()) {
      hsv_in_range({y.view(), cb.view(), cr.view()}, range, region.view(), mask.view(), kernels);
      REQUIRE(count(mask.view()) == expected);
    }
  }
}
