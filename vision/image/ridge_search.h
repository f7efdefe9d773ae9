// SPDX-License-Identifier: Apache-2.0
// Ridges: pixels brighter, less green and less colourful than what lies some pixels to both sides of them, where that
// is green. The whole search is one kernel: a frame has thousands of them, and every table of kernels walks the image
// in steps of its own width.
//
// A pixel's luma is a sum of weight 4, of itself and its two neighbours across the look. It stands out when it is
// larger than the larger sum of both sides by a sixteenth of that and by a margin. A side is a number of pixels away at
// which a line of the block's width is left behind, whatever its slant.
#pragma once

#include <cstdint>

#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"
#include "vision/image/line_width.h"

namespace touchline {

inline constexpr int max_ridge_px = 8;                       // wider lines have their own colour
inline constexpr int max_ridge_reach_px = max_ridge_px + 2;  // steps to a side, at least 2: the blur

struct RidgeSearch {
  ConstYuv420View image;  // both planes of chroma have one stride
  ConstBitView roi;       // where to look
  ConstBitView green;
  ImageView<const LineWidth> widths;
  std::int32_t axis_cb = 0, axis_cr = 0;            // the carpet's direction of chroma, up to +-256
  std::int16_t weak_margin = 0, strong_margin = 0;  // 0 to 8,192, strong at least weak
  /// Pixels that are strong already are not looked at. A pixel found is added to weak, and to strong when one of its
  /// looks stands out by that margin.
  BitView strong, weak;
};

}  // namespace touchline
