// SPDX-License-Identifier: Apache-2.0
#include "vision/green.h"

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/hsv.h"

namespace touchline {
namespace {

constexpr std::int32_t magnitude(std::int32_t v) { return v < 0 ? -v : v; }

/// The value below which `percent` of the samples lie.
std::int32_t percentile(const Histogram& histogram, std::int32_t samples, std::int32_t percent) {
  const std::int32_t rank = samples * percent / 100;
  std::int32_t below = 0;
  for (std::int32_t v = 0; v < 256; ++v) {
    below += histogram[v];
    if (below > rank) return v;
  }
  return 255;
}

/// Every second chroma sample of each direction whose pixel is in the mask. `around` is a mask that holds this one.
template <typename Rows>
void for_sample_rows(const ConstYuv420View& image, ConstBitView mask, ConstBitView around, Rows rows) {
  for (int y = 1; y < image.cb.height; y += 2) {
    rows(CarpetRow{image.y.row(2 * y), image.cb.row(y), image.cr.row(y), mask.row(2 * y), around.row(2 * y),
                   mask.width});
  }
}

/// Narrows the hue to the flanks of the highest peak: where the count falls below 1/32 of it, two steps (4 degrees)
/// more.
void narrow_hue(const Histogram& hues, HsvRange& range) {
  const auto smooth = [&hues](std::int32_t h) {
    std::int32_t sum = 0;
    for (std::int32_t k = h - 1; k <= h + 1; ++k) sum += hues[std::clamp<std::int32_t>(k, 0, 255)];
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
void measure_colour(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate,
                    const CarpetKernels& kernels, CarpetModel& carpet) {
  CarpetColours colours;
  for_sample_rows(image, ground, ground, [&](const CarpetRow& row) { kernels.count_colours(row, gate, colours); });
  carpet.samples = colours.samples;
  if (colours.samples == 0) return;
  narrow_hue(colours.hues, carpet.green);
  // Half of the median: a worn or glaring patch is still carpet, and white on it is less than half as saturated.
  const std::int32_t half_median = percentile(colours.saturations, colours.samples, 50) / 2;
  carpet.green.saturation_low = static_cast<std::uint8_t>(std::max<std::int32_t>(half_median, gate.saturation_low));
}

/// Medians of the chroma ratios, luma of the shadows, noise: from the samples inside today's range, `green`.
void measure_ratios(const ConstYuv420View& image, ConstBitView ground, ConstBitView green, const CarpetKernels& kernels,
                    CarpetModel& carpet) {
  ChromaSums sums;
  for_sample_rows(image, green, ground, [&](const CarpetRow& row) { kernels.sum_chroma(row, sums); });
  carpet.samples = sums.samples;
  const std::int32_t longest = std::max(magnitude(sums.cb), magnitude(sums.cr));
  if (sums.samples == 0 || longest == 0) {
    carpet.samples = 0;
    return;
  }
  // Scaled by the longer component: a Euclidean norm is not needed, only one and the same scale for all pixels.
  carpet.axis_cb = sums.cb * 128 / longest * 2;
  carpet.axis_cr = sums.cr * 128 / longest * 2;

  CarpetRatios ratios;
  const ChromaAxis axis{carpet.axis_cb, carpet.axis_cr};
  for_sample_rows(image, green, ground, [&](const CarpetRow& row) { kernels.count_ratios(row, axis, ratios); });
  carpet.greenness_ratio = std::max<std::int32_t>(percentile(ratios.greenness, sums.samples, 50), 1);
  carpet.chroma_ratio = std::max<std::int32_t>(percentile(ratios.chroma, sums.samples, 50), 1);
  carpet.shadow_luma = percentile(ratios.lumas, sums.samples, 5);
  // Of Gaussian noise sigma the mean of |2 a - b - c| is sqrt(6) sigma sqrt(2 / pi) = 1.954 sigma; 16 / 1.954 = 8.19.
  carpet.noise =
      ratios.rough_samples == 0 ? 16 : std::max<std::int32_t>(ratios.roughness * 819 / (ratios.rough_samples * 100), 4);
}

}  // namespace

CarpetModel measure_carpet(const ConstYuv420View& image, ConstBitView ground, const HsvRange& gate, BitView green,
                           const Kernels& kernels) {
  CarpetModel carpet;
  carpet.green = gate;
  measure_colour(image, ground, gate, kernels.carpet, carpet);
  if (carpet.samples > 0) {
    hsv_in_range(image, carpet.green, ground, green, kernels);
    measure_ratios(image, ground, green, kernels.carpet, carpet);
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
