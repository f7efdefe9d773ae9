// SPDX-License-Identifier: Apache-2.0
// What is a line: white between green on both sides, of the width that the table says. Drawn as text: 'g' carpet, 'W' white,
// 's' carpet in the shadow, 'w' white in the shadow, 'y' yellow, 'k' black, 'f' floor, '+' a worn line: carpet with a little white.
#include "vision/white_search.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Colour {
  std::uint8_t y, cb, cr;
};
Colour colour(char c) {
  switch (c) {
    case 'W': return {210, 128, 128};
    case 'w': return {90, 128, 128};
    case 's': return {42, 119, 113};
    case 'y': return {170, 55, 155};
    case 'k': return {20, 128, 128};
    case 'f': return {150, 128, 128};
    case '+': return {104, 112, 104};
    default: return {88, 110, 99};
  }
}

struct Drawing {
  int w, h;
  std::vector<std::uint8_t> y, cb, cr;
  Bits green, white, lines, scratch;
  std::vector<LineWidth> widths;
  CarpetModel carpet;

  /// Each character is 2x2 pixels, so that it has a chroma sample of its own.
  Drawing(const std::vector<std::string>& rows, LineWidth width)
      : w(2 * static_cast<int>(rows[0].size())), h(2 * static_cast<int>(rows.size())), green(w, h), white(w, h), lines(w, h), scratch(w, h) {
    y.resize(static_cast<std::size_t>(w * h));
    cb.resize(static_cast<std::size_t>(w * h / 4));
    cr = cb;
    for (int v = 0; v < h; ++v) {
      for (int u = 0; u < w; ++u) {
        const Colour c = colour(rows[static_cast<std::size_t>(v / 2)][static_cast<std::size_t>(u / 2)]);
        y[static_cast<std::size_t>(v * w + u)] = c.y;
        cb[static_cast<std::size_t>(v / 2 * (w / 2) + u / 2)] = c.cb;
        cr[static_cast<std::size_t>(v / 2 * (w / 2) + u / 2)] = c.cr;
      }
    }
    widths.assign(static_cast<std::size_t>(((w + 7) / 8) * ((h + 7) / 8)), width);
    Bits all(w, h);
    fill(all.view());
    carpet = measure_carpet(image(), all.view(), {35, 90, 40, 255, 10, 255});
    REQUIRE(carpet.samples > 0);
    carpet.noise = 16;
    carpet.shadow_luma = 40;
    find_green(image(), all.view(), carpet, green.view());
    find_white(image(), all.view(), carpet, white.view());
  }
  [[nodiscard]] ConstYuv420View image() const {
    return {{y.data(), w, h, w}, {cb.data(), w / 2, h / 2, w / 2}, {cr.data(), w / 2, h / 2, w / 2}};
  }
  [[nodiscard]] LineWidthView table() const { return {widths.data(), (w + 7) / 8, (h + 7) / 8, (w + 7) / 8}; }
  SpanCounts spans() { return find_white_spans(image(), green.view(), white.view(), table(), carpet, lines.view()); }
  void ridges() {
    Bits all(w, h);
    fill(all.view());
    find_white_ridges(image(), all.view(), green.view(), table(), carpet, lines.view(), scratch.view());
  }
  [[nodiscard]] bool line_at(int column, int row) const { return lines.view().get(2 * column, 2 * row); }
};

constexpr LineWidth four_px{64, 64, 90};  // in every direction

std::vector<std::string> upright(const std::string& row, int rows = 12) { return std::vector<std::string>(static_cast<std::size_t>(rows), row); }

}  // namespace

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
