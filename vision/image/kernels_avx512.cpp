// SPDX-License-Identifier: Apache-2.0
// Kernels for x86-64 with AVX-512: F, BW, DQ, VL, VBMI, VBMI2 and VNNI. This file alone is compiled for it: nothing
// here may be inlined elsewhere, and no inline function of a header may be called, or the linker could hand its copy to
// those that run on older processors.
#include "vision/image/kernels.h"

#if defined(__x86_64__) && defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512DQ__) && \
    defined(__AVX512VL__) && defined(__AVX512VBMI__) && defined(__AVX512VBMI2__) && defined(__AVX512VNNI__)
// Without optimisation g++'s gathers are macros, whose conversions are warned of where they are used.
#pragma GCC diagnostic ignored "-Wsign-conversion"
#if !defined(__clang__)  // g++ 12 finds them in its own header (bug 105593)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <immintrin.h>
#pragma GCC diagnostic pop
#endif
#include "vision/image/block_widths_loops.h"
#include "vision/image/carpet_rows_avx512.h"
#include "vision/image/change_rows_loops.h"
#include "vision/image/count_loops.h"
#include "vision/image/edge_rows_loops.h"
#include "vision/image/half_level_loops.h"
#include "vision/image/halve_rows_avx512.h"
#include "vision/image/luma_bands_avx512.h"
#include "vision/image/mask_rows_avx512.h"
#include "vision/image/mean_rows_loops.h"
#include "vision/image/reduce_columns_avx512.h"
#include "vision/image/ridge_search_avx512.h"
#include "vision/image/thinning_loops.h"
#include "vision/image/unpack_rows_loops.h"
#include "vision/line_probe_loops.h"
#include "vision/probe_moments_avx512.h"
#include "vision/white_spans_avx512.h"

namespace touchline {

Kernels avx512_kernels() {
  return {
      .name = "avx512",
      .halve_frame = halve_avx512::halve_frame,
      .unpack = unpack_rows::kernels(),
      .subsample = subsample_loops::kernels(reduce_avx512::reduce_columns),
      .change_rows = change_rows::run,
      .mean_of_four = mean_rows::mean_of_four,
      .find_ridges = ridge_avx512::find_ridges,
      .find_spans = spans_avx512::find_spans,
      .hsv_rows = bands_avx512::hsv_rows,
      .white_rows = bands_avx512::white_rows,
      .join_squares = mask_avx512::join_squares,
      .grow_rows = mask_avx512::grow_rows,
      .trim_border = mask_avx512::trim_border,
      .block_widths = block_widths::measure,
      .carpet = carpet_avx512::kernels(),
      .edges = edge_rows::kernels(),
      .window_moments = nullptr,  // probes.moments takes sixteen windows at once
      .below_half_level = half_level::below_half_level,
      .count_bits = bit_count::count_bits,
      .thin = thinning::run,
      .probes = probe::kernels<Sixteen>(probe_avx512::moments),
  };
}

}  // namespace touchline

#else

namespace touchline {
Kernels avx512_kernels() { return {}; }
}  // namespace touchline

#endif
