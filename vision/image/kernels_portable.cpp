// SPDX-License-Identifier: Apache-2.0
#include "vision/image/carpet_rows_loops.h"
#include "vision/image/carpet_rows_words.h"
#include "vision/image/change_rows_loops.h"
#include "vision/image/edge_rows_loops.h"
#include "vision/image/half_level_loops.h"
#include "vision/image/kernels.h"
#include "vision/image/luma_bands_words.h"
#include "vision/image/mean_rows_loops.h"
#include "vision/image/ridge_search_loops.h"
#include "vision/image/ridge_search_words.h"
#include "vision/image/subsample_loops.h"
#include "vision/image/vector_registers.h"
#include "vision/line_probe_loops.h"

namespace touchline {

Kernels portable_kernels() {
  if constexpr (!vector_registers) return word_kernels();
  return {
      .name = "portable",
      .halve_frame = nullptr,
      .unpack = {},
      .subsample = subsample_loops::kernels(),
      .change_rows = change_rows::run,
      .mean_of_four = mean_rows::mean_of_four,
      .find_ridges = ridge::find_ridges,
      .find_spans = nullptr,
      .hsv_rows = bands::hsv_rows,
      .white_rows = bands::white_rows,
      .join_squares = nullptr,
      .grow_rows = nullptr,
      .trim_border = nullptr,
      .block_widths = nullptr,
      .carpet = carpet::kernels(),
      .edges = edge_rows::kernels(),
      .window_moments = nullptr,
      .below_half_level = half_level::below_half_level,
      .count_bits = nullptr,
      .thin = nullptr,
      .probes = probe::kernels<Eight>(),
  };
}
Kernels word_kernels() {
  return {
      .name = "words",
      .halve_frame = nullptr,
      .unpack = {},
      .subsample = subsample_loops::kernels(),
      .change_rows = change_rows::run,
      .mean_of_four = nullptr,
      .find_ridges = ridge_words::find_ridges,
      .find_spans = nullptr,
      .hsv_rows = band_words::hsv_rows,
      .white_rows = band_words::white_rows,
      .join_squares = nullptr,
      .grow_rows = nullptr,
      .trim_border = nullptr,
      .block_widths = nullptr,
      .carpet = carpet_words::kernels(),
      .edges = {},
      .window_moments = nullptr,
      .below_half_level = nullptr,
      .count_bits = nullptr,
      .thin = nullptr,
      .probes = probe::kernels<One>(),
  };
}

LumaBand portable_band(const HsvBandPlan& plan, std::uint8_t cb, std::uint8_t cr) {
  LumaBand band;
  bands::hsv_samples(plan, &cb, &cr, 1, &band.low, &band.high);
  return band;
}

}  // namespace touchline
