// SPDX-License-Identifier: Apache-2.0
// Canny by rolling rows: row y + 1 is blurred, then row y has its gradient, then row y - 1 its maxima.
#include "vision/image/canny.h"

#include <algorithm>
#include <bit>

#include "vision/image/bit_ops.h"
#include "vision/image/bit_pack.h"

namespace touchline {
namespace {

/// The blur is not divided by its 16, so that nothing is rounded: magnitudes are 16 times those of the thresholds.
constexpr int blur_scale = 16;

/// Columns that have to be looked at: all that the region reaches.
struct Columns {
  int first = 0;
  int end = 0;
};

/// Rows of samples -1..width; index 0 is column 0.
class RollingRows {
 public:
  RollingRows(CannyMemory memory, int width) : rows_(memory.rows), stride_(canny_row_stride(width)) {
    assert(rows_.size() >= static_cast<std::size_t>(canny_rows * stride_));
    std::fill(rows_.begin(), rows_.begin() + canny_rows * stride_, std::uint16_t{0});
  }
  [[nodiscard]] std::uint16_t* vertical() const { return row(0); }
  [[nodiscard]] std::uint16_t* column_sums() const { return row(1); }
  [[nodiscard]] std::int16_t* column_steps() const { return signed_row(2); }
  [[nodiscard]] std::uint16_t* blurred(int y) const { return row(3 + (y + 3) % 3); }
  [[nodiscard]] std::uint16_t* magnitude(int y) const { return row(6 + (y + 3) % 3); }
  [[nodiscard]] std::int16_t* gx(int y) const { return signed_row(9 + (y & 1)); }
  [[nodiscard]] std::int16_t* gy(int y) const { return signed_row(11 + (y & 1)); }

 private:
  [[nodiscard]] std::uint16_t* row(int i) const { return rows_.data() + i * stride_ + 1; }
  /// Signed and unsigned types of one width may look at the same memory.
  [[nodiscard]] std::int16_t* signed_row(int i) const { return reinterpret_cast<std::int16_t*>(row(i)); }
  std::span<std::uint16_t> rows_;
  int stride_;
};

/// The outermost samples repeat beyond the image.
template <typename T>
void repeat_ends(T* row, int width) {
  row[-1] = row[0];
  row[width] = row[width - 1];
}

/// out = 3x3 binomial around row y, times 16.
void blur_row(const ImageView<const std::uint8_t>& gray, int y, Columns columns, std::uint16_t* vertical,
              std::uint16_t* out) {
  const std::uint8_t* above = gray.row(std::max(y - 1, 0));
  const std::uint8_t* here = gray.row(y);
  const std::uint8_t* below = gray.row(std::min(y + 1, gray.height - 1));
  const int first = std::max(columns.first - 1, 0);
  const int end = std::min(columns.end + 1, gray.width);
  for (int x = first; x < end; ++x) vertical[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
  repeat_ends(vertical, gray.width);
  for (int x = columns.first; x < columns.end; ++x) {
    out[x] = static_cast<std::uint16_t>(vertical[x - 1] + 2 * vertical[x] + vertical[x + 1]);
  }
}

/// Sobel of row y and its magnitude.
void gradient_row(const RollingRows& rows, int y, int width, int height, Columns columns) {
  const std::uint16_t* above = rows.blurred(std::max(y - 1, 0));
  const std::uint16_t* here = rows.blurred(y);
  const std::uint16_t* below = rows.blurred(std::min(y + 1, height - 1));
  std::uint16_t* sums = rows.column_sums();
  std::int16_t* steps = rows.column_steps();
  const int first = std::max(columns.first - 1, 0);
  const int end = std::min(columns.end + 1, width);
  for (int x = first; x < end; ++x) {
    sums[x] = static_cast<std::uint16_t>(above[x] + 2 * here[x] + below[x]);
    steps[x] = static_cast<std::int16_t>(below[x] - above[x]);
  }
  repeat_ends(sums, width);
  repeat_ends(steps, width);
  std::int16_t* gx = rows.gx(y);
  std::int16_t* gy = rows.gy(y);
  std::uint16_t* magnitude = rows.magnitude(y);
  for (int x = columns.first; x < columns.end; ++x) {
    const auto dx = static_cast<std::int16_t>(sums[x + 1] - sums[x - 1]);
    const auto dy = static_cast<std::int16_t>(steps[x - 1] + 2 * steps[x] + steps[x + 1]);
    const auto ax = static_cast<std::int16_t>(dx < 0 ? -dx : dx);
    const auto ay = static_cast<std::int16_t>(dy < 0 ? -dy : dy);
    const std::int16_t most = std::max(ax, ay);
    const std::int16_t least = std::min(ax, ay);
    gx[x] = dx;
    gy[x] = dy;
    magnitude[x] = static_cast<std::uint16_t>(most + (least * 3) / 8);
  }
}

/// Gradients of a row, and magnitudes of it and its neighbours.
struct GradientRows {
  const std::int16_t* gx = nullptr;
  const std::int16_t* gy = nullptr;
  const std::uint16_t* above = nullptr;
  const std::uint16_t* here = nullptr;
  const std::uint16_t* below = nullptr;
};

/// 1 when the magnitude at x is the largest along its gradient. Of two equal neighbours in a row of increasing
/// gradient direction the first stays.
BitWord is_maximum(const GradientRows& neighbours, int x) {
  const int gx = neighbours.gx[x];
  const int gy = neighbours.gy[x];
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
  // The gradient's line meets the neighbours' ring at least / most of the way from the side to the corner. Without a
  // branch: on noise no processor could predict one.
  const int here = row[x] * most;
  const int ahead = side_ahead * (most - least) + corner_ahead * least;
  const int back = side_back * (most - least) + corner_back * least;
  return (here > ahead ? BitWord{1} : BitWord{0}) & (here >= back ? BitWord{1} : BitWord{0});
}

/// Bits of 64 columns from `x0` whose magnitude is at least `threshold`.
BitWord at_least(const std::uint16_t* magnitude, int x0, int end, int threshold) {
  std::array<std::uint8_t, bits_per_word> flags{};
  const int used = std::min(bits_per_word, end - x0);
  for (int i = 0; i < used; ++i) flags[static_cast<std::size_t>(i)] = magnitude[x0 + i] >= threshold ? 1 : 0;
  return pack_flags(flags.data());
}

/// Weak and strong maxima of row y inside the region.
void find_maxima(const RollingRows& rows, int y, Columns columns, ConstBitView roi, const CannyThresholds& thresholds,
                 BitView weak, BitView strong) {
  const std::uint16_t* magnitude = rows.magnitude(y);
  const GradientRows gradients = {rows.gx(y), rows.gy(y), rows.magnitude(y - 1), magnitude, rows.magnitude(y + 1)};
  for (int i = columns.first / bits_per_word; i * bits_per_word < columns.end; ++i) {
    if (roi.row(y)[i] == 0) continue;
    const int x0 = i * bits_per_word;
    BitWord maxima = 0;
    BitWord candidates = roi.row(y)[i] & at_least(magnitude, x0, columns.end, thresholds.low * blur_scale);
    if (candidates == 0) continue;
    for (; candidates != 0; candidates &= candidates - 1) {
      const int bit = std::countr_zero(candidates);
      maxima |= is_maximum(gradients, x0 + bit) << bit;
    }
    weak.row(y)[i] = maxima;
    strong.row(y)[i] = maxima & at_least(magnitude, x0, columns.end, thresholds.high * blur_scale);
  }
}

struct Extent {
  int top = 0;
  int bottom = -1;
  Columns columns;
};

/// Rows and columns (in whole words, and one more on either side) that the region reaches.
Extent extent_of(ConstBitView roi) {
  const int words = words_for(roi.width);
  int first = words;
  int last = -1;
  Extent extent;
  for (int y = 0; y < roi.height; ++y) {
    for (int i = 0; i < words; ++i) {
      if (roi.row(y)[i] == 0) continue;
      first = std::min(first, i);
      last = std::max(last, i);
      if (extent.bottom < 0) extent.top = y;
      extent.bottom = y;
    }
  }
  extent.columns = {std::max(first * bits_per_word - 2, 0), std::min((last + 1) * bits_per_word + 2, roi.width)};
  return extent;
}

}  // namespace

GrowResult find_edges(const ImageView<const std::uint8_t>& gray, ConstBitView roi, const CannyThresholds& thresholds,
                      CannyMemory memory, BitView weak, BitView edges) {
  assert(gray.width == roi.width && gray.height == roi.height && gray.width == edges.width);
  clear(weak);
  clear(edges);
  const Extent extent = extent_of(roi);
  if (extent.bottom < 0) return {};
  const RollingRows rows(memory, gray.width);
  const int height = gray.height;
  const Columns columns = extent.columns;

  // Gradients of rows top - 1 to bottom + 1, as far as there are such.
  const int first = std::max(extent.top - 1, 0);
  const int last = std::min(extent.bottom + 1, height - 1);
  for (int y = std::max(first - 1, 0); y <= std::min(first, height - 1); ++y) {
    blur_row(gray, y, columns, rows.vertical(), rows.blurred(y));
  }
  for (int y = first; y <= last + 1; ++y) {
    if (y + 1 < height) blur_row(gray, y + 1, columns, rows.vertical(), rows.blurred(y + 1));
    if (y < height) {
      gradient_row(rows, y, gray.width, height, columns);
    } else {
      std::fill_n(rows.magnitude(y), gray.width, std::uint16_t{0});  // beyond the image there is no edge
    }
    if (y - 1 >= extent.top && y - 1 <= extent.bottom) find_maxima(rows, y - 1, columns, roi, thresholds, weak, edges);
  }
  return grow_inside(edges, weak);
}

}  // namespace touchline
