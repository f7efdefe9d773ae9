// SPDX-License-Identifier: Apache-2.0
// The carpet's colour (paper section IV-B: HSV min-max filter), adapted to the light of the frame by itself: the
// configuration gives a wide gate, the pixels that see ground say where in it today's carpet lies.
#pragma once

#include <cstdint>

#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"
#include "vision/vision_config.h"

namespace touchline {

/// What the carpet and the white on it look like in this frame. Ratios of chroma to luma do not change with
/// brightness: a shadow's edge is no edge in them.
struct CarpetModel {
  HsvRange green;            // today's range inside the configured gate
  std::int32_t axis_cb = 0;  // chroma direction of the carpet, |axis| about 256
  std::int32_t axis_cr = 0;
  std::int32_t greenness_ratio = 0;  // median of (chroma along the axis) / luma, 2^-8
  std::int32_t chroma_ratio = 0;     // median of (|cb| + |cr|) / luma, 2^-8
  std::int32_t shadow_luma = 0;      // 5th percentile of the carpet's luma: nothing darker is white
  std::int32_t noise = 0;            // standard deviation of a luma sample, 1/16 grey level
  std::int32_t samples = 0;          // 0: no carpet in view, and nothing else is meaningful
};

/// Looks at every second chroma sample of `ground`; integer; about 15,000 samples at 640x480. `green` is set to the
/// pixels of `ground` in the carpet's colour; to none when `samples` is 0.
CarpetModel measure_carpet(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate, BitView green,
                           const Kernels& kernels = portable_kernels());

/// Pixels of `ground` that lack the carpet's colour and any other strong one, and are no shadow -> `white`: lines, but
/// also grey floor, robots and the ball. A line is what is of its width, between green.
void find_white(const ConstYuv420View& image, ConstBitView ground, const CarpetModel& carpet, BitView white,
                const Kernels& kernels = portable_kernels());

}  // namespace touchline
