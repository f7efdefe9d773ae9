// SPDX-License-Identifier: Apache-2.0
// Canny by rolling rows, for processors without vector registers: row y + 1 is blurred, then row y has its gradient,
// then row y - 1 its maxima.
#include "vision/image/canny.h"

#include <algorithm>
#include <bit>

#include "vision/image/bit_ops.h"
#include "vision/image/canny_rows.h"
#include "vision/image/canny_words.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {

/// Rows of samples -1..width; index 0 is column 0.
class RollingRows : private CannyRows {
 public:
  using CannyRows::CannyRows;
  [[nodiscard]] std::uint16_t* vertical() const { return row(0); }
  [[nodiscard]] std::uint16_t* column_sums() const { return row(1); }
  [[nodiscard]] std::int16_t* column_steps() const { return signed_row(2); }
  [[nodiscard]] std::uint16_t* blurred(int y) const { return row(3 + (y + 3) % 3); }
  [[nodiscard]] std::uint16_t* magnitude(int y) const { return row(6 + (y + 3) % 3); }
  [[nodiscard]] std::int16_t* gx(int y) const { return signed_row(9 + (y & 1)); }
  [[nodiscard]] std::int16_t* gy(int y) const { return signed_row(11 + (y & 1)); }
};

/// The outermost samples repeat beyond the image.
template <typename T>
void repeat_ends(T* row, int width) {
  row[-1] = row[0];
  row[width] = row[width - 1];
}

/// 1 when the magnitude at x is the largest along its gradient. Of two equal neighbours in a row of increasing
/// gradient direction the first stays. Gradients have slope_bias.
std::uint32_t is_maximum(const EdgeNeighbours& neighbours, int x) {
  const int gx = neighbours.gx[x] - canny_words::slope_bias;
  const int gy = neighbours.gy[x] - canny_words::slope_bias;
  const int ax = gx < 0 ? -gx : gx;
  const int ay = gy < 0 ? -gy : gy;
  const int sx = gx < 0 ? -1 : 1;
  const std::uint16_t* ahead_row = gy < 0 ? neighbours.above : neighbours.below;
  const std::uint16_t* back_row = gy < 0 ? neighbours.below : neighbours.above;
  const std::uint16_t* row = neighbours.here;
  const int corner_ahead = ahead_row[x + sx];
  const int corner_back = back_row[x - sx];
  const int side_ahead = ax >= ay ? row[x + sx] : ahead_row[x];
  const int side_back = ax >= ay ? row[x - sx] : back_row[x];
  const int most = std::max(ax, ay);
  const int least = std::min(ax, ay);
  // The gradient's line meets the neighbours' ring at least / most of the way from the side to the corner.
  const int here = row[x] * most;
  if (here <= side_ahead * (most - least) + corner_ahead * least) return 0;
  return here >= side_back * (most - least) + corner_back * least ? 1U : 0U;
}

/// The columns, at most 64, whose magnitude is at least the threshold.
BitWord find_slopes(const EdgeSlopes& s, EdgeColumns columns, int threshold) {
  BitWord bits = 0;
  int x = columns.first;
  for (; x + canny_words::block_px <= columns.end; x += canny_words::block_px) {
    bits |= BitWord{canny_words::slopes_of_block(s, x, threshold)} << (x - columns.first);
  }
  for (; x < columns.end; ++x) {
    bits |= (canny_words::slope_at(s, x, threshold) ? BitWord{1} : BitWord{0}) << (x - columns.first);
  }
  return bits;
}

EdgeMaxima maxima_of_word(const EdgeNeighbours& rows, int x0, BitWord candidates, int threshold) {
  EdgeMaxima found;
  for (int half = 0; half < bits_per_word; half += 32) {  // a register of a small processor each
    std::uint32_t weak_bits = 0;
    std::uint32_t strong_bits = 0;
    for (auto left = static_cast<std::uint32_t>(candidates >> half); left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const std::uint32_t maximum = is_maximum(rows, x0 + half + bit) << bit;
      weak_bits |= maximum;
      if (rows.here[x0 + half + bit] >= threshold) strong_bits |= maximum;
    }
    found.weak |= BitWord{weak_bits} << half;
    found.strong |= BitWord{strong_bits} << half;
  }
  return found;
}

constexpr int block_px = 32;
/// Blocks of a row, a bit each: widths up to 2048.
using Blocks = std::uint64_t;

/// Blocks of a row that the region reaches.
Blocks blocks_of(ConstBitView roi, int y) {
  Blocks blocks = 0;
  if (y < 0 || y >= roi.height) return blocks;
  for (int i = 0; i < words_for(roi.width); ++i) {
    const BitWord word = roi.row(y)[i];
    if (word == 0) continue;
    if ((word & 0xFFFFFFFFU) != 0) blocks |= Blocks{1} << (2 * i);
    if (word >> block_px != 0) blocks |= Blocks{2} << (2 * i);
  }
  return blocks;
}

/// Calls visit(columns) for each run of blocks, with two columns more on either side.
template <typename Visit>
void for_each_run(Blocks blocks, int width, Visit visit) {
  while (blocks != 0) {
    const int first = std::countr_zero(blocks);
    const int end = first + std::countr_one(blocks >> first);
    visit(EdgeColumns{std::max(first * block_px - 2, 0), std::min(end * block_px + 2, width)});
    blocks &= end >= 64 ? Blocks{0} : ~Blocks{0} << end;
  }
}

/// The blocks of five rows: what the gradients and maxima of rows y - 1 to y + 1 look at around row y.
class NearBlocks {
 public:
  explicit NearBlocks(ConstBitView roi, int first) : roi_(roi), next_(first) {}
  /// Rows in order, each at most once again.
  Blocks at(int y) {
    for (; next_ <= y + 2; ++next_) ring(next_) = blocks_of(roi_, next_);
    Blocks near = 0;
    for (int v = y - 2; v <= y + 2; ++v) near |= ring(v);
    return near;
  }

 private:
  std::uint64_t& ring(int y) { return ring_[static_cast<std::size_t>(y & 7)]; }
  ConstBitView roi_;
  int next_;
  std::array<Blocks, 8> ring_{};
};

/// One column more on either side, inside the image.
EdgeColumns wider(EdgeColumns columns, int width) {
  return {std::max(columns.first - 1, 0), std::min(columns.end + 1, width)};
}

/// out = 3x3 binomial around row y, times 16.
void blur_row(const ImageView<const std::uint8_t>& gray, int y, Blocks blocks, std::uint16_t* vertical,
              std::uint16_t* out) {
  for_each_run(blocks, gray.width, [&](EdgeColumns columns) {
    canny_words::sum_rows(gray.row(std::max(y - 1, 0)), gray.row(y), gray.row(std::min(y + 1, gray.height - 1)),
                          wider(columns, gray.width), vertical);
    repeat_ends(vertical, gray.width);
    canny_words::sum_columns(vertical, columns, out);
  });
}

/// The words of a row in whose reach, one pixel to every side, the region has a pixel.
BitWord near_region(ConstBitView roi, int y, int i) {
  BitWord near = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, roi.height - 1); ++v) {
    const BitWord* row = roi.row(v);
    near |= row[i];
    if (i > 0) near |= row[i - 1] >> (bits_per_word - 1);
    if (i + 1 < words_for(roi.width)) near |= row[i + 1] << (bits_per_word - 1);
  }
  return near;
}

/// Sobel of row y and its magnitude, near the region. `candidates`: its pixels whose magnitude is at least `threshold`.
void gradient_row(const RollingRows& rows, ConstBitView roi, int y, Blocks blocks, int threshold, BitView candidates) {
  if (blocks == 0) return;
  const int width = roi.width;
  const EdgeSlopes slopes = {rows.column_sums(), rows.column_steps(), rows.gx(y), rows.gy(y), rows.magnitude(y)};
  for_each_run(blocks, width, [&](EdgeColumns columns) {
    canny_words::sum_and_step(rows.blurred(std::max(y - 1, 0)), rows.blurred(y),
                              rows.blurred(std::min(y + 1, roi.height - 1)), wider(columns, width), rows.column_sums(),
                              rows.column_steps());
  });
  repeat_ends(rows.column_sums(), width);
  repeat_ends(rows.column_steps(), width);
  const Blocks reached = blocks | blocks << 1 | blocks >> 1;
  for (int i = 0; i < words_for(width); ++i) {
    if ((reached >> (2 * i) & 3U) == 0) continue;
    const BitWord near = near_region(roi, y, i);
    if (near == 0) continue;
    // Half by half, each with one column of the other.
    const int x0 = i * bits_per_word;
    const int end = std::min(x0 + bits_per_word, width);
    const int half = std::min(x0 + block_px, width);
    BitWord bits = 0;
    if (near << (block_px - 1) != 0) bits = find_slopes(slopes, {x0, half}, threshold);
    if (near >> (block_px - 1) != 0 && half < end) {
      bits |= find_slopes(slopes, {half, end}, threshold) << block_px;
    }
    candidates.row(y)[i] = roi.row(y)[i] & bits;
  }
}

/// Of the candidates of row y the weak and the strong maxima.
void find_maxima(const RollingRows& rows, int y, int strong_threshold, BitView weak, BitView strong) {
  const EdgeNeighbours neighbours = {
      rows.gx(y), rows.gy(y), rows.magnitude(y - 1), rows.magnitude(y), rows.magnitude(y + 1), weak.width};
  for (int i = 0; i < words_for(weak.width); ++i) {
    if (weak.row(y)[i] == 0) continue;
    const EdgeMaxima found = maxima_of_word(neighbours, i * bits_per_word, weak.row(y)[i], strong_threshold);
    weak.row(y)[i] = found.weak;
    strong.row(y)[i] = found.strong;
  }
}

}  // namespace

RowRange reached_rows(ConstBitView roi) {
  RowRange rows;
  const int words = words_for(roi.width);
  for (int y = 0; y < roi.height; ++y) {
    BitWord any = 0;
    for (int i = 0; i < words; ++i) any |= roi.row(y)[i];
    if (any == 0) continue;
    if (rows.last < 0) rows.first = y;
    rows.last = y;
  }
  return rows;
}

GrowResult find_edges_by_words(const ImageView<const std::uint8_t>& gray, ConstBitView roi,
                               const CannyThresholds& thresholds, CannyMemory memory, BitView weak, BitView edges) {
  assert(gray.width == roi.width && gray.height == roi.height && gray.width == edges.width);
  clear(weak);
  clear(edges);
  const RowRange reached = reached_rows(roi);
  if (reached.last < reached.first) return {};
  const RollingRows rows(memory, gray.width);
  const int height = gray.height;
  NearBlocks near(roi, reached.first - 4);
  const auto blur = [&](int y) { blur_row(gray, y, near.at(y), rows.vertical(), rows.blurred(y)); };

  // Gradients of one row more on either side, as far as there are such.
  const int first = std::max(reached.first - 1, 0);
  const int last = std::min(reached.last + 1, height - 1);
  for (int y = std::max(first - 1, 0); y <= first; ++y) blur(y);
  for (int y = first; y <= last + 1; ++y) {
    if (y + 1 < height) blur(y + 1);
    if (y < height) {
      gradient_row(rows, roi, y, near.at(y), thresholds.low * blur_scale, weak);
    } else {
      std::fill_n(rows.magnitude(y), gray.width, std::uint16_t{0});  // beyond the image there is no edge
    }
    if (y - 1 >= reached.first && y - 1 <= reached.last) {
      find_maxima(rows, y - 1, thresholds.high * blur_scale, weak, edges);
    }
  }
  return grow_inside(edges, weak);
}

GrowResult find_edges(const ImageView<const std::uint8_t>& gray, ConstBitView roi, const CannyThresholds& thresholds,
                      CannyMemory memory, BitView weak, BitView edges, const Kernels& kernels) {
  if constexpr (vector_registers) {
    if (kernels.edges.maxima != nullptr) {
      return find_edges_by_blocks(gray, roi, thresholds, memory, weak, edges, kernels.edges);
    }
  }
  return find_edges_by_words(gray, roi, thresholds, memory, weak, edges);
}

}  // namespace touchline
