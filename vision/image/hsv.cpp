// SPDX-License-Identifier: Apache-2.0
// HSV from YCbCr (definition: A. R. Smith, "Color Gamut Transform Pairs", SIGGRAPH 1978). All quotients are compared by
// cross-multiplication, so that filter and definition agree exactly.
#include "vision/image/hsv.h"

#include <algorithm>

namespace touchline {
namespace {

// r, g, b minus luma, in 1/256: 1.402 Cr, -0.344 Cb - 0.714 Cr, 1.772 Cb.
constexpr std::int32_t red_cr = 359, green_cb = -88, green_cr = -183, blue_cb = 454;
constexpr int offset_bits = 8;
constexpr int half_units_per_turn = 360;  // hue is 0..179 and rounded: its borders are at odd multiples of a half

struct Offsets {
  std::int32_t red, green, blue;
};
constexpr Offsets offsets(std::int32_t cb, std::int32_t cr) {
  return {red_cr * cr, green_cb * cb + green_cr * cr, blue_cb * cb};
}

constexpr std::uint32_t reciprocal_of(std::int32_t divisor) {
  return divisor > 0 ? (1U << 23) / static_cast<std::uint32_t>(divisor) : 0U;
}

bool hue_in_range(int hue, const HsvRange& range) {
  if (range.hue_low <= range.hue_high) return hue >= range.hue_low && hue <= range.hue_high;
  return hue >= range.hue_low || hue <= range.hue_high;
}

}  // namespace

Hsv hsv_from_ycbcr(std::uint8_t y, std::uint8_t cb, std::uint8_t cr) {
  const auto [red, green, blue] = offsets(cb - 128, cr - 128);
  const std::int32_t high = std::max({red, green, blue});
  const std::int32_t chroma = high - std::min({red, green, blue});
  const std::int32_t value = (std::int32_t{y} << offset_bits) + high;
  Hsv hsv;
  hsv.value = static_cast<std::uint8_t>(std::clamp<std::int32_t>((value + 128) >> offset_bits, 0, 255));
  if (chroma == 0) return hsv;
  hsv.saturation = 255;
  if (value > 0) {
    hsv.saturation = static_cast<std::uint8_t>(std::min<std::int32_t>((510 * chroma + value) / (2 * value), 255));
  }
  // 60 half units either side of the channel that is largest; in units of 1 / chroma.
  std::int32_t half_units = 0;
  if (high == red) {
    half_units = 60 * (green - blue);
  } else if (high == green) {
    half_units = 60 * (blue - red) + 120 * chroma;
  } else {
    half_units = 60 * (red - green) + 240 * chroma;
  }
  if (half_units < 0) half_units += half_units_per_turn * chroma;
  hsv.hue = static_cast<std::uint8_t>((half_units + chroma) / (2 * chroma) % 180);
  return hsv;
}

bool in_range(const Hsv& hsv, const HsvRange& range) {
  return hue_in_range(hsv.hue, range) && hsv.saturation >= range.saturation_low &&
         hsv.saturation <= range.saturation_high && hsv.value >= range.value_low && hsv.value <= range.value_high;
}

void hsv_row(const std::uint8_t* y, const std::uint8_t* cb, const std::uint8_t* cr, int width, Hsv* out) {
  for (int x = 0; x < width; ++x) out[x] = hsv_from_ycbcr(y[x], cb[x / 2], cr[x / 2]);
}

/// In the sixth of the turn that holds the border, "hue >= border" reads num * 60 + (base - border) * chroma >= 0, and
/// num and chroma are linear in Cb and Cr there: a half plane through gray. Beyond the sixth it goes on straight.
ChromaHalfPlane HsvFilter::at_hue(int half_units) {
  const int border = (half_units + half_units_per_turn) % half_units_per_turn;
  const auto form = [&](std::int32_t cb, std::int32_t cr) {
    const auto [red, green, blue] = offsets(cb, cr);
    switch (border / 60) {
      case 0: return 60 * (green - blue) + (0 - border) * (red - blue);
      case 1: return 60 * (blue - red) + (120 - border) * (green - blue);
      case 2: return 60 * (blue - red) + (120 - border) * (green - red);
      case 3: return 60 * (red - green) + (240 - border) * (blue - red);
      case 4: return 60 * (red - green) + (240 - border) * (blue - green);
      default: return 60 * (green - blue) + (360 - border) * (red - green);
    }
  };
  return {form(1, 0), form(0, 1)};
}

HsvFilter::HsvFilter(const HsvRange& range) {
  const int low = range.hue_low;
  const int high = range.hue_high;
  const int steps = (high - low + 180) % 180 + 1;  // hues in the range
  plan_.value_low = range.value_low;
  plan_.value_high = range.value_high;
  plan_.any_hue = steps == 180;
  plan_.wide = steps > 90;
  plan_.from = at_hue(2 * low - 1);
  plan_.to = at_hue(2 * high + 1);
  if (range.saturation_low > 0) plan_.divisor_low = 2 * range.saturation_low - 1;
  if (range.saturation_high < 255) plan_.divisor_high = 2 * range.saturation_high + 1;
  plan_.reciprocal_low = reciprocal_of(plan_.divisor_low);
  plan_.reciprocal_high = reciprocal_of(plan_.divisor_high);
  if (hue_in_range(0, range) && range.saturation_low == 0) plan_.neutral = {range.value_low, range.value_high};
  plan_.rare = steps <= 30 && plan_.neutral.low > plan_.neutral.high;
  // Saturation is 255 chroma / value, and chroma at most 359 + 454 times the larger of |cb| and |cr|.
  const std::int32_t least_value = std::max<std::int32_t>(range.value_low * 256 - 128, 0);
  const std::int32_t least_saturation = std::max<std::int32_t>(2 * range.saturation_low - 1, 0);  // of 510
  plan_.least_chroma = std::max<std::int32_t>(least_value * least_saturation / (510 * (359 + 454)), 1);
}

LumaBand HsvFilter::luma_range(std::uint8_t cb, std::uint8_t cr) const { return portable_band(plan_, cb, cr); }

void hsv_in_range(const ConstYuv420View& picture, const HsvRange& range, ConstBitView region, BitView out,
                  const Kernels& kernels) {
  const HsvFilter filter(range);
  BandMemo memo;
  memo.clear();
  for_band_rows(picture, region, out, memo, [&](const BandRows& rows) { kernels.hsv_rows(filter.plan(), rows); });
}

}  // namespace touchline
