// SPDX-License-Identifier: Apache-2.0
// What is a line: white between green on both sides, of the width that the table says.
#include "vision/white_search.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "platform/core/rng.h"
#include "tests/support/kernel_tables.h"
#include "tests/vision/drawn_carpet.h"
#include "vision/line_mask.h"

using namespace touchline;
using namespace touchline::test;

TEST_CASE("a stripe of a line's width is found, wherever the light falls") {
  for (const char* row : {"ggggggggWWgggggggg", "ssssssssWWgggggggg", "sssssssswwssssssss"}) {
    CAPTURE(row);
    Drawing d(upright(row), four_px);
    CHECK(d.spans().found == 24);
    CHECK(d.line_at(8, 5));
    CHECK(d.line_at(9, 5));
    CHECK(count(d.lines.view()) == 4 * 24);
  }
}

TEST_CASE("lying stripes are found along the columns") {
  std::vector<std::string> rows(12, "gggggggggggggggg");
  rows[5] = rows[6] = "gWWWWWWWWWWWWWWg";
  Drawing d(rows, four_px);
  d.spans();
  CHECK(d.line_at(3, 5));
  CHECK(d.line_at(12, 6));
  CHECK_FALSE(d.line_at(3, 4));
}

TEST_CASE("what is no line, and why") {
  SUBCASE("twice as wide") {
    Drawing d(upright("gggggggWWWWWWggggggg"), four_px);
    const SpanCounts counts = d.spans();
    CHECK(counts.found == 0);
    CHECK(counts.too_wide == 24);
  }
  SUBCASE("much thinner") {
    Drawing d(upright("ggggggggWggggggggg"), {160, 160, 220});
    CHECK(d.spans().too_thin == 24);
    CHECK(count(d.lines.view()) == 0);
  }
  SUBCASE("yellow, as a post") {
    Drawing d(upright("ggggggggyygggggggg"), four_px);
    CHECK(d.spans().not_white == 24);
    d.ridges();
    CHECK(count(d.lines.view()) == 0);
  }
  SUBCASE("black, as a robot's foot") {
    Drawing d(upright("ggggggggkkgggggggg"), four_px);
    d.spans();
    d.ridges();
    CHECK(count(d.lines.view()) == 0);
  }
  SUBCASE("green on one side only, as the floor beside the carpet") {
    Drawing d(upright("ggggggggggggffffff"), four_px);
    d.spans();
    d.ridges();
    CHECK(count(d.lines.view()) == 0);
  }
  SUBCASE("a stripe of light between two shadows") {
    Drawing d(upright("ssssssssggssssssss"), four_px);
    d.spans();
    d.ridges();
    CHECK(count(d.lines.view()) == 0);
  }
  SUBCASE("a level strip too high for a level line, though a slanting line may be as high") {
    std::vector<std::string> rows(14, "gggggggggggggggggggggggg");
    rows[5] = rows[6] = rows[7] = rows[8] = "gffffffffffffffffffffffg";
    Drawing d(rows, {80, 16, 90});  // 5 px along the row, 1 px along the column
    d.spans();
    CHECK(count(d.lines.view()) == 0);
  }
}

TEST_CASE("a worn line whose pixels count as carpet is a ridge") {
  Drawing d(upright("gggggggg+ggggggggg"), {32, 32, 45});
  d.spans();
  CHECK(count(d.lines.view()) == 0);
  d.ridges();
  CHECK(d.line_at(8, 5));
  CHECK_FALSE(d.line_at(7, 5));
  CHECK_FALSE(d.line_at(10, 5));
}

TEST_CASE("a weak stretch of a line is kept by a strong one, and dropped alone") {
  std::vector<std::string> rows = upright("gggggggg+ggggggggg", 16);
  for (std::size_t i = 0; i < 4; ++i) rows[i][8] = 'W';
  Drawing d(rows, {32, 32, 45});
  d.carpet.noise = 60;  // the worn part stands out by 16 of 88 grey levels: between weak and strong
  d.ridges();
  CHECK(d.line_at(8, 2));
  CHECK(d.line_at(8, 12));
  Drawing alone(upright("gggggggg+ggggggggg", 16), {32, 32, 45});
  alone.carpet.noise = 60;
  alone.ridges();
  CHECK(count(alone.lines.view()) == 0);
}

TEST_CASE("the crossing of two lines is filled by growing") {
  std::vector<std::string> rows(16, "ggggggggWWWggggggggg");
  for (const std::size_t i : {6U, 7U, 8U}) rows[i] = "WWWWWWWWWWWWWWWWWWWW";
  Drawing d(rows, {96, 96, 136});
  d.spans();
  CHECK_FALSE(d.line_at(9, 7));
  grow_into_white(d.white.view(), d.table(), d.lines.view(), d.scratch.view());
  CHECK(d.line_at(9, 7));
  CHECK_FALSE(d.line_at(5, 3));
}

TEST_CASE("the mask's border is trimmed to where the luma is nearer to the line's") {
  Drawing d(upright("ggggggggWWgggggggg"), four_px);
  set_span(d.lines.view(), 10, 13, 22, true);
  set_span(d.lines.view(), 11, 13, 22, true);
  set_span(d.lines.view(), 12, 13, 22, true);
  for (int pass = 0; pass < 2; ++pass) trim_to_half_level(d.image().y, d.lines.view(), d.scratch.view());
  CHECK(d.lines.view().get(16, 11));
  CHECK(d.lines.view().get(19, 11));
  CHECK_FALSE(d.lines.view().get(14, 11));
  CHECK_FALSE(d.lines.view().get(21, 11));
}

namespace {

/// Gaps of all lengths in noise, some of them longer than a word, between widths of which some are as large.
struct NoisyGaps {
  int w, h;
  std::vector<std::uint8_t> y;
  Bits green, white;
  std::vector<LineWidth> widths;
  CarpetModel carpet;

  NoisyGaps(int width, int height, std::uint64_t seed) : w(width), h(height), green(w, h), white(w, h) {
    Rng rng(seed);
    for (int i = 0; i < w * h; ++i) y.push_back(static_cast<std::uint8_t>(rng.below(60)));
    fill(green.view());
    for (int i = 0; i < w * h / 150 + 2; ++i) add_hole(rng);
    for (int i = 0; i < (w + 7) / 8 * ((h + 7) / 8); ++i) {
      const std::uint32_t base = rng.below(8) == 0 ? 2000 : 20 + rng.below(100);
      const auto some = [&] { return static_cast<std::uint16_t>(base + rng.below(base)); };
      widths.push_back(rng.below(10) == 0 ? LineWidth{} : LineWidth{some(), some(), some()});
    }
    carpet.samples = 1;
    carpet.noise = static_cast<std::int32_t>(rng.below(40));
  }
  void add_hole(Rng& rng) {
    const auto below = [&](int n) { return static_cast<int>(rng.below(static_cast<std::uint32_t>(n))); };
    const bool is_long = below(10) == 0;
    const int left = below(w), top = below(h);
    const int right = left + below(is_long ? 120 : 10), bottom = top + below(is_long ? 8 : 10);
    const bool is_bright = below(4) != 0;
    for (int v = top; v <= std::min(bottom, h - 1); ++v) {
      set_span(green.view(), v, left, right, false);
      for (int u = left; u <= std::min(right, w - 1); ++u) {
        white.view().set(u, v, below(4) != 0);
        if (is_bright) y[static_cast<std::size_t>(v * w + u)] = static_cast<std::uint8_t>(60 + below(190));
      }
    }
  }
  SpanCounts spans(BitView lines, const Kernels& kernels) const {
    ConstYuv420View image;
    image.y = {y.data(), w, h, w};
    const int columns = (w + 7) / 8;
    return find_white_spans(image, green.view(), white.view(), {widths.data(), columns, (h + 7) / 8, columns}, carpet,
                            lines, kernels);
  }
};

}  // namespace

TEST_CASE("every table of kernels finds the same spans, and for the same reasons no others") {
  SpanCounts all;
  for (const int width : {4, 60, 64, 130, 320, 1280}) {
    for (const int height : {1, 7, 90}) {
      for (std::uint64_t seed = 0; seed < 10; ++seed) {
        const NoisyGaps gaps(width, height, seed);
        Bits expected(width, height), lines(width, height);
        const SpanCounts counts = gaps.spans(expected.view(), portable_kernels());
        all.found += counts.found;
        all.too_wide += counts.too_wide;
        all.too_thin += counts.too_thin;
        all.not_white += counts.not_white;
        all.not_bright += counts.not_bright;
        for (const Kernels& kernels : runnable_tables()) {
          CAPTURE(kernels.name);
          CAPTURE(width);
          CAPTURE(height);
          CAPTURE(seed);
          fill(lines.view());  // what was there before does not count
          const SpanCounts found = gaps.spans(lines.view(), kernels);
          CHECK(found.found == counts.found);
          CHECK(found.too_wide == counts.too_wide);
          CHECK(found.too_thin == counts.too_thin);
          CHECK(found.not_white == counts.not_white);
          CHECK(found.not_bright == counts.not_bright);
          REQUIRE(equal(lines.view(), expected.view()));
        }
      }
    }
  }
  for (const int some : {all.found, all.too_wide, all.too_thin, all.not_white, all.not_bright}) CHECK(some > 1000);
}
