// SPDX-License-Identifier: Apache-2.0
// What the search for ridges (ridge_search_loops.h) compares: sums of luma, colours, and the pixels on their way from
// one comparison to the next. Everything is local to the file that includes it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/ridge_pixels_loops.h"
#include "vision/image/ridge_reaches_loops.h"

namespace touchline {
namespace {
namespace ridge {

/// Sums of weight 4, and what a pixel has to exceed by the margin to stand out from a side with that sum: it and a
/// sixteenth. The larger side has the larger bar, too.
template <std::size_t Rows, std::size_t Columns>
struct Sums {
  alignas(64) std::int16_t sum[Rows][Columns];
  alignas(64) std::int16_t bar[Rows][Columns];

  [[gnu::always_inline]] void set(int row, int column, const Pixels& sums) {
    sums.store(&sum[row][column]);
    with_sixteenth(sums).store(&bar[row][column]);
  }
};

struct Colour {
  std::int32_t greenness = 0, chroma = 0;
};
/// Negative where a pixel is whiter than a side. Chroma over luma, compared without a division, nor a branch, which no
/// processor could foresee: at least an eighth less green than the side, and not more of any colour: a yellow post is
/// brighter and less green than the carpet, but no line.
[[gnu::always_inline]] inline std::int32_t whiter(const Colour& here, int luma, const Colour& side, int side_luma) {
  const std::int32_t more_green = here.greenness * 8 * side_luma - side.greenness * 7 * luma;  // up to 2^28
  const std::int32_t more_colour = here.chroma * side_luma - side.chroma * luma;
  return more_green & more_colour;
}

/// Pixels that are bright enough, until they are compared in colour: the rows with any, look by look.
struct Bright {
  std::uint32_t left[(max_looks + 1) * strip_rows];   // the first zero is behind the last
  std::uint32_t which[(max_looks + 1) * strip_rows];  // look and row, as strip_rows * look + row
  Rows strong[max_looks];
  int reach[max_looks];
  int looks = 0;
  int count = 0;

  [[gnu::always_inline]] void add(int new_reach, Rows new_left, Rows new_strong) {
    const int first = looks * strip_rows;
    reach[looks] = new_reach;
    strong[looks++] = new_strong;
    for (int r = 0; r < strip_rows; ++r) {
      left[count] = new_left[r];
      which[count] = static_cast<std::uint32_t>(first + r);
      count += new_left[r] != 0 ? 1 : 0;
    }
  }
};

struct Found {
  Rows weak{}, strong{};
};

}  // namespace ridge
}  // namespace
}  // namespace touchline
