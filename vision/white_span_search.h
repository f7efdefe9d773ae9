// SPDX-License-Identifier: Apache-2.0
// What the search for white spans (white_search.h) reads, writes and counts, for its kernels.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/line_width.h"

namespace touchline {

/// Gaps in the green that were looked at, and why they are no line.
struct SpanCounts {
  int found = 0;
  int too_wide = 0;    // wider than a line can look there
  int too_thin = 0;    // narrower than half a line
  int not_white = 0;   // less than half of the gap's pixels are white
  int not_bright = 0;  // not brighter than the green beside it: a shadow, a dark foot
};

/// A picture of at least four columns, and masks of its size.
struct SpanSearch {
  const std::uint8_t* luma = nullptr;
  const std::uint64_t* green = nullptr;
  const std::uint64_t* white = nullptr;
  std::uint64_t* lines = nullptr;     // clear
  const LineWidth* widths = nullptr;  // of each block
  std::ptrdiff_t luma_stride = 0, green_stride = 0, white_stride = 0, lines_stride = 0, widths_stride = 0;
  int width = 0, height = 0;
  std::int32_t least_excess = 0;  // by which a line's two pixels are brighter than 17/16 of two green ones
};

}  // namespace touchline
