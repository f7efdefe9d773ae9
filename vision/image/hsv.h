// SPDX-License-Identifier: Apache-2.0
// Hue, saturation and value, and the min-max filter in them (paper section IV-B), straight from YCbCr and in integers.
//
// With r, g, b = Y + offsets that depend on Cb and Cr alone (the inverse of BT.601, full range, not clamped), max - min
// and the hue depend on chroma alone, and the value is Y + the largest offset. So a range in HSV is, for each chroma
// sample, a range of luma: the filter costs a few multiplications a chroma sample (a quarter of the pixels) and two
// comparisons a pixel.
#pragma once

#include <algorithm>

#include "vision/image/bit_image.h"
#include "vision/image/hsv_range.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/image/luma_bands.h"

namespace touchline {

struct Hsv {
  std::uint8_t hue = 0;         // 0..179, rounded to nearest; 0 for gray
  std::uint8_t saturation = 0;  // 255 (max - min) / max, rounded and clamped to 255; 0 for gray
  std::uint8_t value = 0;       // max, rounded and clamped to 0..255
  bool operator==(const Hsv&) const = default;
};

[[nodiscard]] Hsv hsv_from_ycbcr(std::uint8_t y, std::uint8_t cb, std::uint8_t cr);
[[nodiscard]] bool in_range(const Hsv& hsv, const HsvRange& range);

/// One working row: `width` luma samples, (width + 1) / 2 of each chroma; a chroma sample is that of both its pixels.
void hsv_row(const std::uint8_t* y, const std::uint8_t* cb, const std::uint8_t* cr, int width, Hsv* out);

/// A range made ready. luma_range() agrees with in_range(hsv_from_ycbcr()) for all 2^24 inputs.
class HsvFilter {
 public:
  explicit HsvFilter(const HsvRange& range);
  [[nodiscard]] LumaBand luma_range(std::uint8_t cb, std::uint8_t cr) const;
  /// For the kernels.
  [[nodiscard]] const HsvBandPlan& plan() const { return plan_; }

 private:
  static ChromaHalfPlane at_hue(int half_units);

  HsvBandPlan plan_;
};

/// out = pixels of the region whose colour is in the range. Both masks have the size of the luma plane.
void hsv_in_range(const ConstYuv420View& picture, const HsvRange& range, ConstBitView region, BitView out,
                  const Kernels& kernels = portable_kernels());

/// Calls rows(BandRows) for each row of chroma and the one or two of luma that it belongs to.
template <typename Rows>
void for_band_rows(const ConstYuv420View& picture, ConstBitView region, BitView out, BandMemo& memo, Rows rows) {
  assert(picture.y.width == out.width && picture.y.height == out.height && region.width == out.width);
  for (int y = 0; y < out.height; y += 2) {
    const int below = std::min(y + 1, out.height - 1);
    BandRows two;
    two.cb = picture.cb.row(y / 2);
    two.cr = picture.cr.row(y / 2);
    two.y[0] = picture.y.row(y);
    two.y[1] = picture.y.row(below);
    two.region[0] = region.row(y);
    two.region[1] = region.row(below);
    two.out[0] = out.row(y);
    two.out[1] = out.row(below);
    two.width = out.width;
    two.memo = &memo;
    rows(two);
  }
}

}  // namespace touchline
