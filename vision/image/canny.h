// SPDX-License-Identifier: Apache-2.0
// Canny's edges inside a region (Canny, "A Computational Approach to Edge Detection", PAMI 8(6), 1986; paper section
// IV-C), in integers, with a few rolling rows in place of gradient images.
//
// Gaussian: the binomial 3x3 (1 2 1), sigma 0.7 pixel: lines far away are one to three working pixels wide, and a wider
// one would melt both of their edges; noise was already lowered by the mean over frames and the area weighting.
// Gradient: Sobel 3x3. Magnitude: max + 3/8 min of |gx|, |gy|, within 7 % of the Euclidean one. At the image's border
// the outermost pixels repeat. Non-maximum suppression: along the gradient itself, the magnitude interpolated between
// the two neighbours on either side, by cross-multiplication. Hysteresis: grow_inside(), which needs no stack.
#pragma once

#include <array>
#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/grow.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/image/vector_registers.h"

namespace touchline {

/// Gradient magnitudes in the unit of an unscaled Sobel of gray levels: a ramp of one gray level a pixel has 8, a sharp
/// step of s gray levels has 3 s. 0 < low <= high <= 1400.
struct CannyThresholds {
  int low = 40;
  int high = 90;
};

/// Rolling rows; nothing has to stay between calls.
struct CannyMemory {
  std::span<std::uint16_t> rows;
};
/// With vector registers rows are whole blocks wide, and there are more of them.
inline constexpr int canny_rows = vector_registers ? 17 : 13;
inline constexpr int canny_row_margin = vector_registers ? 32 : 1;
constexpr int canny_row_stride(int width) {
  return (vector_registers ? (width + edge_block_px - 1) / edge_block_px * edge_block_px : width) +
         2 * canny_row_margin;
}
template <int W>
struct CannyStorage {
  std::array<std::uint16_t, static_cast<std::size_t>(canny_rows* canny_row_stride(W))> rows{};
  [[nodiscard]] CannyMemory memory() { return {rows}; }
};

/// edges = edge pixels of `gray` that lie in `roi` and are connected, inside it, to a strong one. `weak` is scratch and
/// holds all local maxima above the low threshold afterwards. All of one size. The result tells whether hysteresis
/// ended within its bound.
GrowResult find_edges(const ImageView<const std::uint8_t>& gray, ConstBitView roi, const CannyThresholds& thresholds,
                      CannyMemory memory, BitView weak, BitView edges, const Kernels& kernels = portable_kernels());
/// The same by the loops of processors without vector registers, for the tests elsewhere.
GrowResult find_edges_by_words(const ImageView<const std::uint8_t>& gray, ConstBitView roi,
                               const CannyThresholds& thresholds, CannyMemory memory, BitView weak, BitView edges);

/// And by the loops of processors with such.
GrowResult find_edges_by_blocks(const ImageView<const std::uint8_t>& gray, ConstBitView roi,
                                const CannyThresholds& thresholds, CannyMemory memory, BitView weak, BitView edges,
                                const EdgeKernels& kernels);

/// Rows that a region reaches; none when last < first.
struct RowRange {
  int first = 0;
  int last = -1;
};
RowRange reached_rows(ConstBitView roi);

}  // namespace touchline
