// SPDX-License-Identifier: Apache-2.0
// What is a line: white between green on both sides, of the width that the table says.
#include "vision/white_search.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

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
