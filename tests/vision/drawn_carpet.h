// SPDX-License-Identifier: Apache-2.0
// Carpets drawn as text: 'g' carpet, 'W' white, 's' carpet in the shadow, 'w' white in the shadow, 'y' yellow, 'k'
// black, 'f' floor,
// '+' a worn line: carpet with a little white. Test support.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/support/ascii_image.h"
#include "vision/green.h"
#include "vision/image/bit_ops.h"
#include "vision/line_width_table.h"
#include "vision/white_search.h"

namespace touchline::test {

struct Colour {
  std::uint8_t y, cb, cr;
};
inline Colour colour(char c) {
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
      : w(2 * static_cast<int>(rows[0].size())),
        h(2 * static_cast<int>(rows.size())),
        green(w, h),
        white(w, h),
        lines(w, h),
        scratch(w, h) {
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
    carpet = measure_carpet(image(), all.view(), {35, 90, 40, 255, 10, 255}, green.view());
    REQUIRE(carpet.samples > 0);
    carpet.noise = 16;
    carpet.shadow_luma = 40;
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

inline std::vector<std::string> upright(const std::string& row, int rows = 12) {
  return std::vector<std::string>(static_cast<std::size_t>(rows), row);
}

}  // namespace touchline::test
