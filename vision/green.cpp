// SPDX-License-Identifier: Apache-2.0
#include "vision/green.h"

#include <algorithm>
#include <array>

#include "vision/image/bit_ops.h"
#include "vision/image/hsv.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

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
  std::int32_t luma, cb, cr;  // chroma as differences from grey
  int x, y;                   // working pixel
  bool inner;                 // the pixels to the left and to the right are in the mask, too
};
/// Every second chroma sample of each direction whose pixel is in the mask. `around` is a mask that holds this one.
template <typename Visit>
void for_each_sample(const ConstYuv420View& image, ConstBitView mask, ConstBitView around, Visit visit) {
  constexpr BitWord every_fourth = 0x4444444444444444U;  // pixels 2, 6, 10, ...: never a word's first or last
  const int words = words_for(mask.width);
  for (int y = 1; y < image.cb.height; y += 2) {
    const std::uint8_t* luma = image.y.row(2 * y);
    const std::uint8_t* cb = image.cb.row(y);
    const std::uint8_t* cr = image.cr.row(y);
    for (int i = 0; i < words; ++i) {
      const BitWord inner = around.row(2 * y)[i] << 1 & around.row(2 * y)[i] >> 1;
      for_each_bit(mask.row(2 * y)[i] & every_fourth, [&](int bit) {
        const int x = i * bits_per_word + bit;
        visit(Sample{luma[x], cb[x / 2] - 128, cr[x / 2] - 128, x, 2 * y, ((inner >> bit) & 1U) != 0});
      });
    }
  }
}

/// Narrows the hue to the flanks of the highest peak: where the count falls below 1/32 of it, two steps (4 degrees)
/// more.
void narrow_hue(const Histogram& hues, HsvRange& range) {
  const auto smooth = [&hues](std::int32_t h) {
    std::int32_t sum = 0;
    for (std::int32_t k = h - 1; k <= h + 1; ++k)
      sum += hues[static_cast<std::size_t>(std::clamp<std::int32_t>(k, 0, 255))];
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
  for_each_sample(image, ground, ground, [&](const Sample& s) {
    const Hsv hsv = hsv_from_ycbcr(static_cast<std::uint8_t>(s.luma), static_cast<std::uint8_t>(s.cb + 128),
                                   static_cast<std::uint8_t>(s.cr + 128));
    if (!in_range(hsv, gate)) return;
    ++hues[hsv.hue];
    ++saturations[hsv.saturation];
    ++samples;
  });
  carpet.samples = samples;
  if (samples == 0) return;
  narrow_hue(hues, carpet.green);
  // Half of the median: a worn or glaring patch is still carpet, and white on it is less than half as saturated.
  const std::int32_t half_median = percentile(saturations, samples, 50) / 2;
  carpet.green.saturation_low = static_cast<std::uint8_t>(std::max<std::int32_t>(half_median, gate.saturation_low));
}

/// Medians of the chroma ratios, luma of the shadows, noise: from the samples inside today's range, `green`.
void measure_ratios(const ConstYuv420View& image, ConstBitView ground, ConstBitView green, CarpetModel& carpet) {
  std::int32_t sum_cb = 0, sum_cr = 0, samples = 0;
  for_each_sample(image, green, ground, [&](const Sample& s) {
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
  for_each_sample(image, green, ground, [&](const Sample& s) {
    const std::int32_t luma = std::max<std::int32_t>(s.luma, 1);
    const std::int32_t along = s.cb * carpet.axis_cb + s.cr * carpet.axis_cr;  // 2^-8
    ++greenness[static_cast<std::size_t>(std::clamp<std::int32_t>(along / luma, 0, 255))];
    ++chroma[static_cast<std::size_t>(std::min<std::int32_t>((magnitude(s.cb) + magnitude(s.cr)) * 256 / luma, 255))];
    ++lumas[static_cast<std::size_t>(s.luma)];
    if (s.inner) {
      const std::uint8_t* row = image.y.row(s.y);
      // Clipped, so that a line's edge does not count as noise.
      roughness += std::min<std::int32_t>(magnitude(2 * row[s.x] - row[s.x - 1] - row[s.x + 1]), 32);
      ++rough_samples;
    }
  });
  carpet.greenness_ratio = std::max<std::int32_t>(percentile(greenness, samples, 50), 1);
  carpet.chroma_ratio = std::max<std::int32_t>(percentile(chroma, samples, 50), 1);
  carpet.shadow_luma = percentile(lumas, samples, 5);
  // Of Gaussian noise sigma the mean of |2 a - b - c| is sqrt(6) sigma sqrt(2 / pi) = 1.954 sigma; 16 / 1.954 = 8.19.
  carpet.noise = rough_samples == 0 ? 16 : std::max<std::int32_t>(roughness * 819 / (rough_samples * 100), 4);
}

}  // namespace

CarpetModel measure_carpet(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate, BitView green,
                           const Kernels& kernels) {
  CarpetModel carpet;
  carpet.green = gate;
  measure_colour(image, ground, gate, carpet);
  if (carpet.samples > 0) {
    hsv_in_range(image, carpet.green, ground, green, kernels);
    measure_ratios(image, ground, green, carpet);
  }
  if (carpet.samples == 0) clear(green);
  return carpet;
}

void find_white(const ConstYuv420View& image, ConstBitView ground, const CarpetModel& carpet, BitView white,
                const Kernels& kernels) {
  if (carpet.samples == 0) {
    clear(white);
    return;
  }
  // Little more than half of the carpet's greenness and three quarters of its chroma: in warm light white has a colour
  // of its own, but not the carpet's; a yellow post or an orange ball has more.
  CarpetLimits limits;
  limits.per_green = 65536 / std::max<std::int32_t>(carpet.greenness_ratio * 9 / 16, 1);
  limits.per_chroma = 65536 / std::max<std::int32_t>(carpet.chroma_ratio * 3 / 4, 1);
  limits.axis_cb = carpet.axis_cb;
  limits.axis_cr = carpet.axis_cr;
  limits.shadow_luma = carpet.shadow_luma;
  BandMemo memo;
  memo.clear();
  for_band_rows(image, ground, white, memo, [&](const BandRows& rows) { kernels.white_rows(limits, rows); });
}

}  // namespace touchline
