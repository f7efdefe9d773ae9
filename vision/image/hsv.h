// SPDX-License-Identifier: Apache-2.0
// Hue, saturation and value, and the min-max filter in them (paper section IV-B), straight from YCbCr and in integers.
//
// With r, g, b = Y + offsets that depend on Cb and Cr alone (the inverse of BT.601, full range, not clamped), max - min
// and the hue depend on chroma alone, and the value is Y + the largest offset. So a range in HSV is, for each chroma
// sample, a range of luma: the filter costs a few multiplications a chroma sample (a quarter of the pixels) and two
// comparisons a pixel.
#pragma once

#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"

namespace touchline {

/// HSV ranges: hue 0..179 (2 degrees a step, the convention of teams' colour files), saturation and value 0..255. All
/// bounds are inside. hue_low > hue_high means the range over zero: hue_low..179 and 0..hue_high.
struct HsvRange {
  std::uint8_t hue_low = 0, hue_high = 179;
  std::uint8_t saturation_low = 0, saturation_high = 255;
  std::uint8_t value_low = 0, value_high = 255;
  bool operator==(const HsvRange&) const = default;
};

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

/// The luma that a chroma sample leaves to a range; empty when low > high.
struct LumaBand {
  std::uint8_t low = 255;
  std::uint8_t high = 0;
};

/// A range made ready. luma_range() agrees with in_range(hsv_from_ycbcr()) for all 2^24 inputs.
class HsvFilter {
 public:
  explicit HsvFilter(const HsvRange& range);
  [[nodiscard]] LumaBand luma_range(std::uint8_t cb, std::uint8_t cr) const;
  /// The same for a row of chroma samples.
  void luma_ranges(const std::uint8_t* cb, const std::uint8_t* cr, int count, std::uint8_t* low,
                   std::uint8_t* high) const;

 private:
  /// Sign of a * cb + b * cr, chroma as differences from 128: on which side of a hue the chroma lies.
  struct HalfPlane {
    std::int32_t a = 0, b = 0;
  };
  static HalfPlane at_hue(int half_units);

  HalfPlane from_;     // >= 0: at or past the range's first hue, as far as half a turn goes
  HalfPlane to_;       // < 0: before the end of its last hue
  bool wide_ = false;  // more than half a turn: one of both is enough
  bool any_hue_ = false;
  std::int32_t divisor_low_ = 0, divisor_high_ = 0;  // 2 S - 1 and 2 S + 1; 0: no bound
  std::uint32_t reciprocal_low_ = 0, reciprocal_high_ = 0;
  std::int32_t value_low_ = 0, value_high_ = 0;
  LumaBand neutral_;  // for gray, which has no hue
};

/// out = pixels of the region whose colour is in the range. Both masks have the size of the luma plane.
/// Widths up to max_hsv_width.
inline constexpr int max_hsv_width = 1280;
void hsv_in_range(const ConstYuv420View& picture, const HsvRange& range, ConstBitView region, BitView out);

/// Bits of one row: low[x / 2] <= y[x] <= high[x / 2], and inside the region. For filters whose luma ranges come from
/// elsewhere. The ranges need not be there where neither this row of the region nor its partner's has a pixel of a
/// word.
void luma_in_range(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high, ConstBitView region,
                   int row, BitWord* out);

}  // namespace touchline
