// SPDX-License-Identifier: Apache-2.0
// White search, far and worn lines: what stands out from the green on both sides.
#include "vision/image/bit_ops.h"
#include "vision/white_search.h"

namespace touchline {

GrowResult find_white_ridges(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, LineWidthView widths,
                             const CarpetModel& carpet, BitView lines, BitView scratch, const Kernels& kernels) {
  if (carpet.samples == 0) return {};
  copy(lines, scratch);
  RidgeSearch search;
  search.image = image;
  search.roi = roi;
  search.green = green;
  search.widths = widths;
  search.axis_cb = carpet.axis_cb;
  search.axis_cr = carpet.axis_cr;
  // The difference of two sums of weight 4 has sqrt(12) of the noise of one luma: 3 and 1.5 sigma, and one grey level.
  search.strong_margin = static_cast<std::int16_t>(carpet.noise * 2 / 3 + 4);
  search.weak_margin = static_cast<std::int16_t>(carpet.noise / 3 + 4);
  search.strong = lines;
  search.weak = scratch;
  kernels.find_ridges(search);
  return grow_inside(lines, scratch);
}

}  // namespace touchline
