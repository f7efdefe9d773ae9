// SPDX-License-Identifier: Apache-2.0
// HSV from YCbCr (definition: A. R. Smith, "Color Gamut Transform Pairs", SIGGRAPH 1978). All quotients are compared by
// cross-multiplication, so that filter and definition agree exactly.
#include "vision/image/hsv.h"

#include <algorithm>
#include <array>

#include "vision/image/bit_ops.h"
#include "vision/image/luma_window.h"

namespace touchline {
namespace {

// r, g, b minus luma, in 1/256: 1.402 Cr, -0.344 Cb - 0.714 Cr, 1.772 Cb.
constexpr std::int32_t red_cr = 359, green_cb = -88, green_cr = -183, blue_cb = 454;
constexpr int offset_bits = 8;
constexpr std::int32_t beyond_all = 1 << 16;  // beyond any luma: no bound
constexpr int half_units_per_turn = 360;      // hue is 0..179 and rounded: its borders are at odd multiples of a half

struct Offsets {
  std::int32_t red, green, blue;
};
constexpr Offsets offsets(std::int32_t cb, std::int32_t cr) {
  return {red_cr * cr, green_cb * cb + green_cr * cr, blue_cb * cb};
}

/// floor(t / (256 * divisor)), held in 0..256 (negative becomes -1). Reciprocal: floor(2^23 / divisor); the estimate
/// is at most one too small.
std::int32_t luma_quotient(std::int32_t t, std::int32_t divisor, std::uint32_t reciprocal) {
  const std::int32_t u = std::clamp<std::int32_t>(t >> offset_bits, 0, 256 * divisor);
  auto q = static_cast<std::int32_t>((static_cast<std::uint32_t>(u) * reciprocal) >> 23);
  q += (q + 1) * divisor <= u ? 1 : 0;
  return t < 0 ? -1 : q;
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
HsvFilter::HalfPlane HsvFilter::at_hue(int half_units) {
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

HsvFilter::HsvFilter(const HsvRange& range) : value_low_(range.value_low), value_high_(range.value_high) {
  const int low = range.hue_low;
  const int high = range.hue_high;
  const int steps = (high - low + 180) % 180 + 1;  // hues in the range
  any_hue_ = steps == 180;
  wide_ = steps > 90;
  from_ = at_hue(2 * low - 1);
  to_ = at_hue(2 * high + 1);
  if (range.saturation_low > 0) divisor_low_ = 2 * range.saturation_low - 1;
  if (range.saturation_high < 255) divisor_high_ = 2 * range.saturation_high + 1;
  reciprocal_low_ = reciprocal_of(divisor_low_);
  reciprocal_high_ = reciprocal_of(divisor_high_);
  if (hue_in_range(0, range) && range.saturation_low == 0) neutral_ = {range.value_low, range.value_high};
}

LumaBand HsvFilter::luma_range(std::uint8_t cb, std::uint8_t cr) const {
  LumaBand range;
  luma_ranges(&cb, &cr, 1, &range.low, &range.high);
  return range;
}

void HsvFilter::luma_ranges(const std::uint8_t* cb, const std::uint8_t* cr, int count, std::uint8_t* low,
                            std::uint8_t* high) const {
  const HsvFilter f = *this;  // a copy that no store through `low` can change: the loop stays in registers
  const std::int32_t any = f.any_hue_ ? 1 : 0;
  const std::int32_t wide = f.wide_ ? 1 : 0;
  const std::int32_t value_floor = f.value_low_ == 0 ? -beyond_all : f.value_low_;
  const std::int32_t value_ceiling = f.value_high_ == 255 ? beyond_all : f.value_high_;
  const std::int32_t neutral_low = f.neutral_.low;
  const std::int32_t neutral_high = f.neutral_.high;
  // No branch in the loop where it vectorises; else what has another hue is left at once.
  for (int i = 0; i < count; ++i) {
    const std::int32_t b = cb[i] - 128;
    const std::int32_t r = cr[i] - 128;
    const std::int32_t past_first = f.from_.a * b + f.from_.b * r >= 0 ? 1 : 0;
    const std::int32_t before_last = f.to_.a * b + f.to_.b * r < 0 ? 1 : 0;
    const std::int32_t hue = any | (past_first & before_last) | (wide & (past_first | before_last));

    if constexpr (!vector_registers) {
      if (hue == 0 && (b != 0 || r != 0)) {
        low[i] = 255;
        high[i] = 0;
        continue;
      }
    }
    const auto [red, green, blue] = offsets(b, r);
    const std::int32_t largest = std::max(std::max(red, green), blue);
    const std::int32_t chroma = largest - std::min(std::min(red, green), blue);
    const std::int32_t value_offset = (largest + 128) >> offset_bits;
    const std::int32_t above_high =
        luma_quotient(510 * chroma - f.divisor_high_ * largest, f.divisor_high_, f.reciprocal_high_) + 1;
    const std::int32_t up_to_low =
        luma_quotient(510 * chroma - f.divisor_low_ * largest, f.divisor_low_, f.reciprocal_low_);
    const std::int32_t at_least = f.divisor_high_ == 0 ? 0 : above_high;
    const std::int32_t at_most = f.divisor_low_ == 0 ? 255 : up_to_low;
    const std::int32_t from = std::max<std::int32_t>(std::max<std::int32_t>(0, value_floor - value_offset), at_least);
    const std::int32_t to = std::min<std::int32_t>(std::min<std::int32_t>(255, value_ceiling - value_offset), at_most);
    const std::int32_t inside = hue & (from <= to ? 1 : 0);
    const std::int32_t coloured_low = inside != 0 ? from : 255;
    const std::int32_t coloured_high = inside != 0 ? to : 0;
    low[i] = static_cast<std::uint8_t>(chroma == 0 ? neutral_low : coloured_low);
    high[i] = static_cast<std::uint8_t>(chroma == 0 ? neutral_high : coloured_high);
  }
}

void luma_in_range(const std::uint8_t* y, const std::uint8_t* low, const std::uint8_t* high, ConstBitView region,
                   int row, BitWord* out) {
  const BitWord* wanted = region.row(row);
  for (int i = 0; i < words_for(region.width); ++i) {
    const int first = i * bits_per_word;
    const int used = std::min(bits_per_word, region.width - first);
    out[i] = wanted[i] == 0 ? 0 : luma_window(y + first, low + first / 2, high + first / 2, used) & wanted[i];
  }
}

void hsv_in_range(const ConstYuv420View& picture, const HsvRange& range, ConstBitView region, BitView out) {
  assert(picture.y.width <= max_hsv_width && picture.y.width == out.width && picture.y.height == out.height);
  const HsvFilter filter(range);
  constexpr int pairs = bits_per_word / 2;
  std::array<std::uint8_t, max_hsv_width / 2> low;
  std::array<std::uint8_t, max_hsv_width / 2> high;
  for (int y = 0; y < out.height; ++y) {
    if (y % 2 == 0) {
      const BitWord* upper = region.row(y);
      const BitWord* lower = region.row(std::min(y + 1, out.height - 1));
      for (int i = 0; i < words_for(out.width); ++i) {
        if ((upper[i] | lower[i]) == 0) continue;
        const int first = i * pairs;
        filter.luma_ranges(picture.cb.row(y / 2) + first, picture.cr.row(y / 2) + first,
                           std::min(pairs, picture.cb.width - first), low.data() + first, high.data() + first);
      }
    }
    luma_in_range(picture.y.row(y), low.data(), high.data(), region, y, out.row(y));
  }
}

}  // namespace touchline
