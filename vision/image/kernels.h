// SPDX-License-Identifier: Apache-2.0
// The loops that gain from wide vectors, as a table of functions that never changes. The caller's configuration holds
// it. Every function gives the results of the portable code, bit for bit (tests/vision/image/kernels_test.cpp), so the
// choice changes nothing but the time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/carpet_rows.h"
#include "vision/image/colour_matrix.h"
#include "vision/image/edge_rows.h"
#include "vision/image/luma_bands.h"
#include "vision/image/moments.h"
#include "vision/image/ridge_search.h"
#include "vision/image/same_size.h"
#include "vision/image/thinning_pass.h"
#include "vision/image/unpack.h"
#include "vision/line_probe.h"
#include "vision/white_span_search.h"

namespace touchline {

/// A frame that is twice as high as the working image, in rows of three interleaved bytes.
struct HalvedFrame {
  const std::uint8_t* source = nullptr;
  std::ptrdiff_t source_stride = 0;
  int source_bytes = 0;                         // of each row
  const std::uint16_t* first_column = nullptr;  // of each working column's window of four source columns
  /// Of each working column of a period, sixteen: w0 w1 three times, 0 0, w2 w3 three times, 0 0; all below 128. What
  /// lies behind a row has no weight.
  const std::int8_t* weights = nullptr;
  int columns = 0;          // a multiple of 8
  int rows = 0;             // of the working image, an even number
  int period = 0;           // columns after which the weights repeat, a multiple of 4
  std::uint16_t scale = 0;  // from sums to 8.6 bit, in 1/65536
  ColourMatrix matrix;
  std::uint8_t* y = nullptr;
  std::uint8_t* cb = nullptr;
  std::uint8_t* cr = nullptr;
  std::ptrdiff_t y_stride = 0, cb_stride = 0, cr_stride = 0;
};

using HalveFrame = void (*)(const HalvedFrame& frame);

/// A row of interleaved sums, and which of them each working column takes with what weight.
struct ColumnSums {
  const std::uint16_t* sums = nullptr;  // three a source column
  int source_columns = 0;
  const std::uint16_t* first_column = nullptr;  // of each working column; its taps are inside the row
  const std::uint16_t* weights = nullptr;       // `taps` a working column
  int columns = 0;
  int taps = 0;
  int weight = 0;                // of all taps of a working column, up to 257
  int shift = 0;                 // of the weighted sum, to what 16 bits hold
  std::uint16_t* out = nullptr;  // four a working column: the channels, and one without a meaning
};
using ReduceColumns = void (*)(const ColumnSums& sums);

/// A working row between the two halves of the work, channel by channel in 8.6 bit.
inline constexpr int subsample_fraction_bits = 6;
struct ChannelRow {
  const std::uint16_t* channel[3] = {};
  int columns = 0;
};

/// Subsampling by any ratio.
struct SubsampleKernels {
  /// sums (+)= weight * row.
  void (*add_row)(const std::uint8_t* row, int count, int weight, bool first, std::uint16_t* sums) = nullptr;
  ReduceColumns reduce_columns = nullptr;
  void (*change_colour)(const ChannelRow& row, const ColourRow& matrix, std::uint8_t* out) = nullptr;
  /// Means of 2x2; at an odd border the last column counts twice.
  void (*halve)(const std::uint16_t* upper, const std::uint16_t* lower, int columns, std::uint16_t* out) = nullptr;
};

/// out = (a + b + c + d + 2) / 4 of four rows of samples.
using MeanOfFour = void (*)(const std::uint8_t* const* rows, int width, std::uint8_t* out);

struct BlockRow;

struct Kernels {
  const char* name = nullptr;
  HalveFrame halve_frame = nullptr;  // null: not offered
  UnpackKernels unpack;              // none: not offered
  SubsampleKernels subsample;
  ChangeRows change_rows = nullptr;
  MeanOfFour mean_of_four = nullptr;  // null: not offered
  void (*find_ridges)(const RidgeSearch& search) = nullptr;
  void (*find_spans)(const SpanSearch& search, SpanCounts& counts) = nullptr;  // null: not offered
  void (*hsv_rows)(const HsvBandPlan& plan, const BandRows& rows) = nullptr;
  void (*white_rows)(const CarpetLimits& limits, const BandRows& rows) = nullptr;
  // Of masks, whole rows at once. False: not for masks as wide as these, and nothing was changed. Null: not offered.
  bool (*join_squares)(BitView mask, bool dilate, int passes) = nullptr;  // (morphology.h)
  /// Adds to `mask` the pixels of `inside` beside its own, step by step: as many steps as row y / rows_a_number says.
  bool (*grow_rows)(ConstBitView inside, const std::uint8_t* steps_of_rows, int rows_a_number, BitView mask) = nullptr;
  /// Takes off `mask` the pixels that are `loose` and lack a neighbour in their row or column.
  bool (*trim_border)(ConstBitView loose, BitView mask) = nullptr;
  void (*block_widths)(const BlockRow& row) = nullptr;  // null: not offered
  CarpetKernels carpet;
  EdgeKernels edges;                                                               // none: not offered
  void (*window_moments)(const MomentWindow& window, Moments& moments) = nullptr;  // null: not offered
  /// Of 64 pixels from `at` on the `wanted` ones whose luma is below the middle between the darkest and the brightest
  /// within two pixels, of which all are in memory. Null: not offered.
  std::uint64_t (*below_half_level)(const std::uint8_t* at, std::ptrdiff_t stride, std::uint64_t wanted) = nullptr;
  int (*count_bits)(const std::uint64_t* words, std::ptrdiff_t size) = nullptr;  // null: not offered
  ThinningKernel thin = nullptr;                                                 // null: thin() has its own
  ProbeKernels probes;
};

/// For every processor.
[[nodiscard]] Kernels portable_kernels();
/// Those of processors without vector registers, for the tests elsewhere.
[[nodiscard]] Kernels word_kernels();
/// One sample of hsv_rows().
[[nodiscard]] LumaBand portable_band(const HsvBandPlan& plan, std::uint8_t cb, std::uint8_t cr);

/// For x86-64 with AVX2; without a name where this build has none. The caller makes sure that the processor has the
/// instructions (platform/processor).
[[nodiscard]] Kernels avx2_kernels();
/// Likewise with AVX-512, of it F, BW, DQ, VL, VBMI, VBMI2 and VNNI.
[[nodiscard]] Kernels avx512_kernels();

}  // namespace touchline
