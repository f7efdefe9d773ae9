// SPDX-License-Identifier: Apache-2.0
// Canny on processors with vector registers, in blocks of 32 columns. Blur and Sobel are one: with the binomial
// b = (1 2 1) and the difference d = (-1 0 1), the gradient along the row is d * b along the row and b * b = (1 4 6 4
// 1) along the column. So each row of luma is looked at once, and all that follows goes down the columns.
#include <algorithm>
#include <array>
#include <bit>

#include "vision/image/bit_ops.h"
#include "vision/image/canny.h"
#include "vision/image/canny_rows.h"

namespace touchline {
namespace {

/// Rows of samples, whole blocks wide, with room for one sample before and behind; each row at its number modulo as
/// many as there are.
class RollingRows : private CannyRows {
 public:
  using CannyRows::CannyRows;
  [[nodiscard]] std::int16_t* steps(int y) const { return signed_row(y % 5); }
  [[nodiscard]] std::int16_t* sums(int y) const { return signed_row(5 + y % 5); }
  [[nodiscard]] std::int16_t* gx(int y) const { return signed_row(10 + y % 2); }
  [[nodiscard]] std::int16_t* gy(int y) const { return signed_row(12 + y % 2); }
  [[nodiscard]] std::uint16_t* magnitude(int y) const { return row(14 + (y + 3) % 3); }
};
static_assert(canny_rows >= 17 || !vector_registers);

/// Blocks of a row, a bit each: widths up to 2048.
using Blocks = std::uint64_t;

/// For each row the blocks with a pixel of the region, or a pixel beside one: those that need a gradient.
class GradientBlocks {
 public:
  GradientBlocks(ConstBitView roi, int first) : roi_(roi), next_(first) {
    const int blocks = (roi.width + edge_block_px - 1) / edge_block_px;
    inside_ = blocks >= 64 ? ~Blocks{0} : (Blocks{1} << blocks) - 1;
  }
  /// Rows in order, each at most five times.
  Blocks at(int y) {
    find_to(y);
    return ring(y);
  }
  /// Blocks whose sums the gradients of five rows need.
  Blocks around(int y) {
    find_to(y + 2);
    return ring(y - 2) | ring(y - 1) | ring(y) | ring(y + 1) | ring(y + 2);
  }

 private:
  void find_to(int y) {
    for (; next_ <= y; ++next_) ring(next_) = find(next_);
  }
  [[nodiscard]] Blocks find(int y) const {
    if (y < 0 || y >= roi_.height) return 0;
    const int words = words_for(roi_.width);
    const BitWord* above = roi_.row(std::max(y - 1, 0));
    const BitWord* here = roi_.row(y);
    const BitWord* below = roi_.row(std::min(y + 1, roi_.height - 1));
    Blocks blocks = 0;
    BitWord before = 0;  // the last column of the word before
    for (int i = 0; i < words; ++i) {
      const BitWord column = above[i] | here[i] | below[i];
      const BitWord near = column | column << 1 | column >> 1 | before;
      if ((column & 1U) != 0 && i > 0) blocks |= Blocks{2} << (2 * i - 2);
      if ((near & 0xFFFFFFFFU) != 0) blocks |= Blocks{1} << (2 * i);
      if (near >> edge_block_px != 0) blocks |= Blocks{2} << (2 * i);
      before = column >> (bits_per_word - 1);
    }
    return blocks & inside_;
  }
  Blocks& ring(int y) { return ring_[static_cast<std::size_t>(y & 7)]; }

  ConstBitView roi_;
  int next_;
  Blocks inside_;
  std::array<Blocks, 8> ring_{};
};

/// Beyond the image its rows come again in reverse: the outermost blurred row repeats then, as blur and gradient need.
int mirrored(int y, int height) {
  const int inside = y < 0 ? -1 - y : y >= height ? 2 * height - 1 - y : y;
  return std::clamp(inside, 0, height - 1);
}

/// The gradients of row y. `weak`: its pixels of the region whose magnitude is at least the threshold.
void find_gradients(const EdgeKernels& kernels, const RollingRows& rows, ConstBitView roi, int y, Blocks blocks,
                    int threshold, BitView weak) {
  if (blocks == 0) return;
  EdgeGradients g;
  for (int k = 0; k < 5; ++k) {
    const int from = mirrored(y + k - 2, roi.height);
    g.steps[k] = rows.steps(from);
    g.sums[k] = rows.sums(from);
  }
  g.gx = rows.gx(y);
  g.gy = rows.gy(y);
  g.magnitude = rows.magnitude(y);
  g.width = roi.width;
  for (; blocks != 0; blocks &= blocks - 1) {
    const int block = std::countr_zero(blocks);
    const BitWord bits = kernels.gradients(g, block * edge_block_px, threshold);
    const int i = block / 2;
    weak.row(y)[i] |= bits << (block % 2 * edge_block_px) & roi.row(y)[i];
  }
}

/// Of the candidates of row y the weak and the strong maxima.
void find_maxima(const EdgeKernels& kernels, const RollingRows& rows, int y, int strong_threshold, BitView weak,
                 BitView strong) {
  const EdgeNeighbours neighbours = {
      rows.gx(y), rows.gy(y), rows.magnitude(y - 1), rows.magnitude(y), rows.magnitude(y + 1), weak.width};
  for (int i = 0; i < words_for(weak.width); ++i) {
    if (weak.row(y)[i] == 0) continue;
    const EdgeMaxima found = kernels.maxima(neighbours, i * bits_per_word, weak.row(y)[i], strong_threshold);
    weak.row(y)[i] = found.weak;
    strong.row(y)[i] = found.strong;
  }
}

}  // namespace

GrowResult find_edges_by_blocks(const ImageView<const std::uint8_t>& gray, ConstBitView roi,
                                const CannyThresholds& thresholds, CannyMemory memory, BitView weak, BitView edges,
                                const EdgeKernels& kernels) {
  assert(gray.width == roi.width && gray.height == roi.height && gray.width == edges.width);
  clear(weak);
  clear(edges);
  const RowRange reached = reached_rows(roi);
  if (reached.last < reached.first) return {};
  const RollingRows rows(memory, gray.width);
  const int first = std::max(reached.first - 1, 0);
  GradientBlocks blocks(roi, first - 2);
  int next = std::max(first - 2, 0);  // row of luma
  for (int y = first; y <= reached.last + 1; ++y) {
    if (y < gray.height) {
      for (; next <= std::min(y + 2, gray.height - 1); ++next) {
        kernels.smooth(gray.row(next), gray.width, blocks.around(next), rows.steps(next), rows.sums(next));
      }
      find_gradients(kernels, rows, roi, y, blocks.at(y), thresholds.low * blur_scale, weak);
    } else {
      std::fill_n(rows.magnitude(y), gray.width, std::uint16_t{0});  // beyond the image there is no edge
    }
    if (y > reached.first) find_maxima(kernels, rows, y - 1, thresholds.high * blur_scale, weak, edges);
  }
  return grow_inside(edges, weak);
}

}  // namespace touchline
