// SPDX-License-Identifier: Apache-2.0
// How many pixels a line may have along a row or a column, from the width table, in integers.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "vision/image/bit_image.h"
#include "vision/line_width_table.h"

namespace touchline {

inline const LineWidth& width_at(LineWidthView widths, int x, int y) {
  return widths.at(std::clamp(x / width_block_px, 0, widths.width - 1),
                   std::clamp(y / width_block_px, 0, widths.height - 1));
}

/// Pixels that a line's extent may have: a quarter more for the roughness of the table, two and a half for the blur of
/// both ends.
constexpr int with_tolerance(int sixteenths) { return (sixteenths * 5 / 4 + 40) / 16; }

inline constexpr int edge_side_px = 3;  // from an edge to where the blur has ended

/// Pixels that a line may have from an edge to the green on its other side.
inline int longest_step(const LineWidth& width) { return with_tolerance(width.slanted) + edge_side_px; }
/// The same for any of the pixels of word `word` of row y.
inline int longest_step(LineWidthView widths, int y, int word, BitWord pixels) {
  constexpr BitWord block = (BitWord{1} << width_block_px) - 1;
  int longest = 0;
  while (pixels != 0) {
    const int bit = std::countr_zero(pixels);
    longest = std::max(longest, longest_step(width_at(widths, word * bits_per_word + bit, y)));
    pixels &= ~(block << (bit & ~(width_block_px - 1)));  // of one entry of the table
  }
  return longest;
}

/// A line that leaves the scan's normal by the slope s = rise / run (in pixels, 0 <= rise <= run) has along the scan
/// the extent sqrt(across^2 + s (slanted^2 - across^2 - other_across^2) + s^2 other_across^2): |J e| of
/// line_width_table.h, with the worse of both diagonals for the mixed term. `across` is the table's extent along the
/// scan, `other_across` that along the other axis.
class ExtentBySlope {
 public:
  constexpr ExtentBySlope(int length, std::uint16_t across, std::uint16_t other_across, std::uint16_t slanted)
      : a_(std::int64_t{across} * across),
        b_(std::int64_t{other_across} * other_across),
        mixed_(std::max<std::int64_t>(std::int64_t{slanted} * slanted - a_ - b_, 0)) {
    const std::int64_t least = std::max(length * 16 - 40, 0) * std::int64_t{4};  // length <= 5/4 extent + 40/16
    least2_ = least * least;
  }
  /// Most lengths are decided without the slope, which takes divisions: the extent grows with it.
  [[nodiscard]] constexpr bool never_wider() const { return least2_ <= 25 * a_; }
  [[nodiscard]] constexpr bool always_wider() const { return least2_ > 25 * (a_ + mixed_ + b_); }
  [[nodiscard]] constexpr bool wider_at(int rise, int run) const {
    const std::int64_t n = rise;
    const std::int64_t d = std::max(run, 1);
    const std::int64_t extent2 = a_ + mixed_ * n / d + b_ * n * n / (d * d);  // 2^-8 square pixels
    return least2_ > 25 * extent2;
  }

 private:
  std::int64_t a_, b_, mixed_;
  std::int64_t least2_ = 0;
};

constexpr bool wider_than_slope_allows(int length, int rise, int run, std::uint16_t across, std::uint16_t other_across,
                                       std::uint16_t slanted) {
  const ExtentBySlope extent(length, across, other_across, slanted);
  if (extent.never_wider()) return false;
  return extent.always_wider() || extent.wider_at(rise, run);
}

}  // namespace touchline
