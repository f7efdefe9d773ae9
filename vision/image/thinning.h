// SPDX-License-Identifier: Apache-2.0
// Zhang-Suen thinning, 64 pixels a word (Zhang and Suen, "A Fast Parallel Algorithm for Thinning Digital Patterns",
// CACM 27(3), 1984; paper section IV-C). The result is that of the textbook, pixel by pixel, with its known losses:
// a 2x2 block vanishes, and so does nearly all of a diagonal two pixels wide. Lines three pixels wide and more stay
// connected.
#pragma once

#include <span>

#include "vision/image/bit_image.h"

namespace touchline {

/// One word a row for each of the last two passes: which words of the row changed in it. Bounds the width.
using ThinningScratch = std::uint32_t;
inline constexpr int max_thinning_width = 32 * bits_per_word;
constexpr int thinning_scratch_size(int height) { return 2 * height; }

/// Passes (two an iteration) that thin() makes at most: a blob loses a layer an iteration, so half the shorter side is
/// usual. Diagonals of width two are eaten from their ends, a pixel an iteration, which is what the longer bound is
/// for.
constexpr int max_thinning_iterations(int width, int height) { return width + height; }

struct ThinningResult {
  int iterations = 0;    // the last one changed nothing
  bool finished = true;  // false: the bound was reached and some lines are thicker than a pixel
};

/// Thins `mask` in place; outside the image counts as zero and border pixels are thinned like all others.
/// `scratch` has thinning_scratch_size(height) elements or more; its contents do not matter. Only words near a change
/// of the last two passes are looked at again, so the cost follows the lines and not the area.
ThinningResult thin(BitView mask, std::span<ThinningScratch> scratch);

}  // namespace touchline
