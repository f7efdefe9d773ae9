// SPDX-License-Identifier: Apache-2.0
// Kernels for x86-64 with AVX2. This file alone is compiled for it: nothing here may be inlined elsewhere, and no
// inline function of a header may be called, or the linker could hand its copy to those that run on older processors.
#include "vision/image/kernels.h"

#if defined(__x86_64__) && defined(__AVX2__)
#include "vision/image/block_widths_loops.h"
#include "vision/image/carpet_rows_loops.h"
#include "vision/image/change_rows_loops.h"
#include "vision/image/count_loops.h"
#include "vision/image/edge_rows_loops.h"
#include "vision/image/half_level_loops.h"
#include "vision/image/halve_rows_avx2.h"
#include "vision/image/luma_bands_avx2.h"
#include "vision/image/mean_rows_loops.h"
#include "vision/image/ridge_search_loops.h"
#include "vision/image/subsample_loops.h"
#include "vision/image/thinning_loops.h"
#include "vision/image/unpack_rows_loops.h"
#include "vision/image/window_moments_avx2.h"
#include "vision/line_probe_loops.h"

namespace touchline {

Kernels avx2_kernels() {
  return {
      .name = "avx2",
      .halve_frame = halve_avx2::halve_frame,
      .unpack = unpack_rows::kernels(),
      .subsample = subsample_loops::kernels(),
      .change_rows = change_rows::run,
      .mean_of_four = mean_rows::mean_of_four,
      .find_ridges = ridge::find_ridges,
      .find_spans = nullptr,
      .hsv_rows = bands_avx2::hsv_rows,
      .white_rows = bands::white_rows,
      .join_squares = nullptr,
      .grow_rows = nullptr,
      .trim_border = nullptr,
      .block_widths = block_widths::measure,
      .carpet = carpet::kernels(),
      .edges = edge_rows::kernels(),
      .window_moments = moments_avx2::window_moments,
      .below_half_level = half_level::below_half_level,
      .count_bits = bit_count::count_bits,
      .thin = thinning::run,
      .probes = probe::kernels<Eight>(),
  };
}

}  // namespace touchline

#else

namespace touchline {
Kernels avx2_kernels() { return {}; }
}  // namespace touchline

#endif
