// SPDX-License-Identifier: Apache-2.0
#include "vision/green.h"

#include <algorithm>
#include <array>
#include <span>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

// Full-range BT.601: what chroma adds to luma in each colour, 2^-8. Hue and max - min depend on chroma alone.
struct Colour {
  std::int32_t r, g, b;
};
constexpr Colour colour_of(std::int32_t cb, std::int32_t cr) { return {359 * cr, -88 * cb - 183 * cr, 454 * cb}; }
constexpr std::int32_t highest(const Colour& c) { return std::max(c.r, std::max(c.g, c.b)); }
constexpr std::int32_t lowest(const Colour& c) { return std::min(c.r, std::min(c.g, c.b)); }

/// HSV hue in steps of 2 degrees, 0..179.
std::int32_t hue_of(const Colour& c) {
  const std::int32_t high = highest(c);
  const std::int32_t delta = high - lowest(c);
  if (delta == 0) return 0;
  std::int32_t hue = 0;
  if (high == c.r) {
    hue = 30 * (c.g - c.b) / delta;
  } else if (high == c.g) {
    hue = 60 + 30 * (c.b - c.r) / delta;
  } else {
    hue = 120 + 30 * (c.r - c.g) / delta;
  }
  return hue < 0 ? hue + 180 : hue % 180;
}

struct Hsv {
  std::int32_t hue, saturation, value;
};
Hsv hsv_of(std::int32_t luma, std::int32_t cb, std::int32_t cr) {
  const Colour c = colour_of(cb, cr);
  const std::int32_t value = std::clamp(luma + (highest(c) + 128) / 256, 1, 255);
  const std::int32_t delta = (highest(c) - lowest(c) + 128) / 256;
  return {hue_of(c), std::min(255 * delta / value, 255), value};
}
bool inside(const Hsv& c, const HsvRange& r) {
  return c.hue >= r.hue_low && c.hue <= r.hue_high && c.saturation >= r.saturation_low &&
         c.saturation <= r.saturation_high && c.value >= r.value_low && c.value <= r.value_high;
}

using Histogram = std::array<std::int32_t, 256>;
/// The value below which `percent` of the samples lie.
std::int32_t percentile(const Histogram& histogram, std::int32_t samples, std::int32_t percent) {
  const std::int32_t rank = samples * percent / 100;
  std::int32_t below = 0;
  for (std::size_t v = 0; v < histogram.size(); ++v) {
    below += histogram[v];
    if (below > rank) return static_cast<std::int32_t>(v);
  }
  return 255;
}

struct Sample {
  std::int32_t luma, cb, cr;
  int x, y;  // working pixel
};
/// Every second chroma sample of each direction whose pixel sees ground.
template <typename Visit>
void for_each_sample(const ConstYuv420View& image, ConstBitView ground, Visit visit) {
  for (int y = 1; y < image.cb.height; y += 2) {
    for (int x = 1; x < image.cb.width; x += 2) {
      if (!ground.get(2 * x, 2 * y)) continue;
      visit(Sample{image.y.at(2 * x, 2 * y), image.cb.at(x, y) - 128, image.cr.at(x, y) - 128, 2 * x, 2 * y});
    }
  }
}

/// Narrows the hue to the flanks of the highest peak: where the count falls below 1/32 of it, two steps (4 degrees) more.
void narrow_hue(const Histogram& hues, HsvRange& range) {
  const auto smooth = [&hues](std::int32_t h) {
    std::int32_t sum = 0;
    for (std::int32_t k = h - 1; k <= h + 1; ++k) sum += hues[static_cast<std::size_t>(std::clamp(k, 0, 255))];
    return sum;
  };
  std::int32_t peak = range.hue_low;
  for (std::int32_t h = range.hue_low; h <= range.hue_high; ++h) {
    if (smooth(h) > smooth(peak)) peak = h;
  }
  constexpr std::int32_t margin = 2;
  std::int32_t low = peak;
  while (low > range.hue_low && smooth(low - 1) * 32 > smooth(peak)) --low;
  std::int32_t high = peak;
  while (high < range.hue_high && smooth(high + 1) * 32 > smooth(peak)) ++high;
  range.hue_low = static_cast<std::uint8_t>(std::max<std::int32_t>(low - margin, range.hue_low));
  range.hue_high = static_cast<std::uint8_t>(std::min<std::int32_t>(high + margin, range.hue_high));
}

/// Hue, saturation and chroma axis of what lies inside the gate.
void measure_colour(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate, CarpetModel& carpet) {
  Histogram hues{};
  Histogram saturations{};
  std::int32_t samples = 0;
  for_each_sample(image, ground, [&](const Sample& s) {
    const Hsv hsv = hsv_of(s.luma, s.cb, s.cr);
    if (!inside(hsv, gate)) return;
    ++hues[static_cast<std::size_t>(hsv.hue)];
    ++saturations[static_cast<std::size_t>(hsv.saturation)];
    ++samples;
  });
  carpet.samples = samples;
  if (samples == 0) return;
  narrow_hue(hues, carpet.green);
  // Half of the median: a worn or glaring patch is still carpet, and white on it is less than half as saturated.
  const std::int32_t half_median = percentile(saturations, samples, 50) / 2;
  carpet.green.saturation_low = static_cast<std::uint8_t>(std::max<std::int32_t>(half_median, gate.saturation_low));
}

/// Medians of the chroma ratios, luma of the shadows, noise: from the samples inside today's range.
void measure_ratios(const ConstYuv420View& image, ConstBitView ground, CarpetModel& carpet) {
  std::int32_t sum_cb = 0, sum_cr = 0, samples = 0;
  for_each_sample(image, ground, [&](const Sample& s) {
    if (!inside(hsv_of(s.luma, s.cb, s.cr), carpet.green)) return;
    sum_cb += s.cb;
    sum_cr += s.cr;
    ++samples;
  });
  carpet.samples = samples;
  const std::int32_t longest = std::max(magnitude(sum_cb), magnitude(sum_cr));
  if (samples == 0 || longest == 0) {
    carpet.samples = 0;
    return;
  }
  // Scaled by the longer component: a Euclidean norm is not needed, only one and the same scale for all pixels.
  carpet.axis_cb = sum_cb * 128 / longest * 2;
  carpet.axis_cr = sum_cr * 128 / longest * 2;

  Histogram greenness{};
  Histogram chroma{};
  Histogram lumas{};
  std::int32_t roughness = 0, rough_samples = 0;
  for_each_sample(image, ground, [&](const Sample& s) {
    if (!inside(hsv_of(s.luma, s.cb, s.cr), carpet.green)) return;
    const std::int32_t luma = std::max(s.luma, 1);
    const std::int32_t along = s.cb * carpet.axis_cb + s.cr * carpet.axis_cr;  // 2^-8
    ++greenness[static_cast<std::size_t>(std::clamp(along / luma, 0, 255))];
    ++chroma[static_cast<std::size_t>(std::min((magnitude(s.cb) + magnitude(s.cr)) * 256 / luma, 255))];
    ++lumas[static_cast<std::size_t>(s.luma)];
    if (s.x + 1 < image.y.width && ground.get(s.x - 1, s.y) && ground.get(s.x + 1, s.y)) {
      const std::uint8_t* row = image.y.row(s.y);
      // Clipped, so that a line's edge does not count as noise.
      roughness += std::min(magnitude(2 * row[s.x] - row[s.x - 1] - row[s.x + 1]), 32);
      ++rough_samples;
    }
  });
  carpet.greenness_ratio = std::max(percentile(greenness, samples, 50), 1);
  carpet.chroma_ratio = std::max(percentile(chroma, samples, 50), 1);
  carpet.shadow_luma = percentile(lumas, samples, 5);
  // Of Gaussian noise sigma the mean of |2 a - b - c| is sqrt(6) sigma sqrt(2 / pi) = 1.954 sigma; 16 / 1.954 = 8.19.
  carpet.noise = rough_samples == 0 ? 16 : std::max(roughness * 819 / (rough_samples * 100), 4);
}

/// The lumas between which a chroma sample makes its pixels belong; low > high: none.
struct LumaRange {
  std::int32_t low = 1, high = 0;
};

/// Sets the pixels of `ground` whose luma lies in the range of their chroma sample.
template <typename RangeOf>
void select(const ConstYuv420View& image, ConstBitView ground, RangeOf range_of, BitView out) {
  clear(out);
  for (int cy = 0; cy < image.cb.height; ++cy) {
    const std::uint8_t* cb = image.cb.row(cy);
    const std::uint8_t* cr = image.cr.row(cy);
    const int last_y = std::min(2 * cy + 1, image.y.height - 1);
    for (int cx = 0; cx < image.cb.width; ++cx) {
      const LumaRange range = range_of(cb[cx] - 128, cr[cx] - 128);
      if (range.low > range.high) continue;
      for (int y = 2 * cy; y <= last_y; ++y) {
        const std::uint8_t* luma = image.y.row(y) + 2 * cx;
        BitWord bits = luma[0] >= range.low && luma[0] <= range.high ? 1 : 0;
        if (2 * cx + 1 < image.y.width && luma[1] >= range.low && luma[1] <= range.high) bits |= 2;
        out.row(y)[2 * cx / bits_per_word] |= bits << (2 * cx % bits_per_word);
      }
    }
  }
  and_with(out, ground);
}

/// Unit chroma of a hue: the colour of full saturation, as (cb, cr).
struct Chroma {
  std::int32_t cb, cr;
};
Chroma chroma_of_hue(std::int32_t hue) {
  const std::int32_t sector = hue / 30;
  const std::int32_t rising = hue % 30;
  const std::int32_t falling = 30 - rising;
  constexpr std::int32_t full = 30;
  std::int32_t r = 0, g = 0, b = 0;
  switch (sector) {
    case 0: r = full, g = rising; break;
    case 1: r = falling, g = full; break;
    case 2: g = full, b = rising; break;
    case 3: g = falling, b = full; break;
    case 4: b = full, r = rising; break;
    default: b = falling, r = full; break;
  }
  return {-43 * r - 85 * g + 128 * b, 128 * r - 107 * g - 21 * b};
}
std::int32_t cross(const Chroma& a, const Chroma& b) { return a.cb * b.cr - a.cr * b.cb; }

}  // namespace

CarpetModel measure_carpet(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate) {
  CarpetModel carpet;
  carpet.green = gate;
  measure_colour(image, ground, gate, carpet);
  if (carpet.samples > 0) measure_ratios(image, ground, carpet);
  return carpet;
}

void find_green(const ConstYuv420View& image, ConstBitView ground, const CarpetModel& carpet, BitView green) {
  if (carpet.samples == 0) {
    clear(green);
    return;
  }
  // Hue grows counter-clockwise in the plane of (cb, cr): the range is a wedge between two directions. Half a step more
  // on each side, as hues are rounded.
  const HsvRange& range = carpet.green;
  const Chroma low = chroma_of_hue(range.hue_low);
  const Chroma high = chroma_of_hue(std::min(range.hue_high + 1, 179));
  const bool wide = range.hue_high - range.hue_low >= 85;  // half a turn and more: one side is enough
  const std::int32_t saturation = std::max<std::int32_t>(range.saturation_low, 1);
  const std::int32_t most = std::max<std::int32_t>(range.saturation_high, 1);
  select(
      image, ground,
      [&](std::int32_t cb, std::int32_t cr) -> LumaRange {
        const Chroma c{cb, cr};
        const bool after_low = cross(low, c) >= 0;
        const bool before_high = cross(c, high) >= 0;
        if (!(wide ? after_low || before_high : after_low && before_high)) return {};
        // Saturation = 255 delta / value, value = luma + highest: a bound on one is a bound on luma.
        const Colour colour = colour_of(cb, cr);
        const std::int32_t added = (highest(colour) + 128) / 256;
        const std::int32_t delta = (highest(colour) - lowest(colour) + 128) / 256;
        if (delta == 0) return {};
        return {std::max(range.value_low - added, most == 255 ? 0 : 255 * delta / most - added),
                std::min<std::int32_t>(range.value_high == 255 ? 255 : range.value_high - added, 255 * delta / saturation - added)};
      },
      green);
}

void find_white(const ConstYuv420View& image, ConstBitView ground, const CarpetModel& carpet, BitView white) {
  if (carpet.samples == 0) {
    clear(white);
    return;
  }
  // Half of the carpet's greenness and three quarters of its chroma: in warm light white has a colour of its own, but not the
  // carpet's; a yellow post or an orange ball has more.
  const std::int32_t green_limit = std::max(carpet.greenness_ratio * 9 / 16, 1);
  const std::int32_t chroma_limit = std::max(carpet.chroma_ratio * 3 / 4, 1);
  const std::int32_t per_green = 65536 / green_limit;
  const std::int32_t per_chroma = 65536 / chroma_limit;
  select(
      image, ground,
      [&](std::int32_t cb, std::int32_t cr) -> LumaRange {
        const std::int32_t along = std::max((cb * carpet.axis_cb + cr * carpet.axis_cr) / 256, 0);
        const std::int32_t by_green = along * per_green / 256;
        const std::int32_t by_chroma = (magnitude(cb) + magnitude(cr)) * per_chroma / 256;
        return {std::max({carpet.shadow_luma, by_green, by_chroma}), 255};
      },
      white);
}

}  // namespace touchline
