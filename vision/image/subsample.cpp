// SPDX-License-Identifier: Apache-2.0
// Area weighting, separable: rows are summed first, in whole interleaved rows, then columns, then colours are changed.
// Every format is unpacked to rows of three interleaved bytes, so that there is one copy of each loop.
#include "vision/image/subsample.h"

#include <algorithm>
#include <numeric>

#include "vision/image/colour_matrix.h"
#include "vision/image/unpack.h"

namespace touchline {
namespace {

/// Three channels and a pad: a pixel is then one vector of four. The fourth lane has no meaning.
constexpr int lanes = 4;

/// 255 * 257 is the largest sum that 16 bit hold.
constexpr int max_exact_cells = 257;
constexpr int rounded_cell = 256;

/// A working pixel between the two halves of the work: 8.6 bit.
constexpr int fraction_bits = 6;

/// sums (+)= weight * row.
void add_row(const std::uint8_t* row, int count, int weight, bool first, std::uint16_t* sums) {
  const auto w = static_cast<std::uint16_t>(weight);
  if (first) {
    for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(row[i] * w);
  } else {
    for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + row[i] * w);
  }
}

/// A sum over `cells` in 16 bit to 8.6 bit by one multiplication: the factor is rounded up and the product down, which
/// is exact for a sum of equal samples (the error is below cells * 255 / 65536 < 1 then).
struct ScaleNarrow {
  using Sum = std::uint16_t;
  std::uint16_t factor = 0;
  explicit ScaleNarrow(int cells) : factor(static_cast<std::uint16_t>(((1 << 22) + cells - 1) / cells)) {}
  std::uint16_t operator()(Sum sum) const {
    return static_cast<std::uint16_t>((std::uint32_t{sum} * std::uint32_t{factor}) >> 16);
  }
};

/// A sum over 256 * 256 cells in 32 bit to 8.6 bit.
struct ScaleWide {
  using Sum = std::uint32_t;
  std::uint16_t operator()(Sum sum) const { return static_cast<std::uint16_t>(sum >> (16 - fraction_bits)); }
};

struct ColumnTable {
  const std::uint16_t* first = nullptr;
  const std::uint16_t* weights = nullptr;
  int columns = 0;
  int taps = 0;
};

/// Weighted sums of neighbouring pixels. Taps is their number when it is known at compile time, else 0.
template <int Taps, typename Scale>
void reduce_columns(const std::uint16_t* sums, ColumnTable table, Scale scale, std::uint16_t* out) {
  using Sum = typename Scale::Sum;
  const int taps = Taps != 0 ? Taps : table.taps;
  const std::uint16_t* weight = table.weights;
  for (int x = 0; x < table.columns; ++x, weight += taps) {
    const std::uint16_t* source = sums + 3 * table.first[x];
    Sum total[lanes] = {};
    for (int t = 0; t < taps; ++t) {
      for (int c = 0; c < lanes; ++c) {
        total[c] = static_cast<Sum>(total[c] + static_cast<Sum>(Sum{source[3 * t + c]} * Sum{weight[t]}));
      }
    }
    for (int c = 0; c < lanes; ++c) out[lanes * x + c] = scale(total[c]);
  }
}

template <typename Scale>
void reduce_columns(const std::uint16_t* sums, ColumnTable table, Scale scale, std::uint16_t* out) {
  switch (table.taps) {
    case 1: return reduce_columns<1>(sums, table, scale, out);
    case 2: return reduce_columns<2>(sums, table, scale, out);
    case 3: return reduce_columns<3>(sums, table, scale, out);
    case 4: return reduce_columns<4>(sums, table, scale, out);
    case 5: return reduce_columns<5>(sums, table, scale, out);
    default: return reduce_columns<0>(sums, table, scale, out);
  }
}

void write_luma(const std::uint16_t* pixels, int width, const ColourRow& m, std::uint8_t* out) {
  for (int x = 0; x < width; ++x, pixels += lanes) out[x] = apply(m, pixels[0], pixels[1], pixels[2], fraction_bits);
}

/// A chroma sample is that of the mean of its 2x2 pixels; at an odd border the last row or column counts twice.
void write_chroma(const std::uint16_t* upper, const std::uint16_t* lower, int width, const ColourMatrix& m,
                  std::uint8_t* cb, std::uint8_t* cr) {
  const auto write = [&](int x, int left, int right) {
    std::int32_t sum[3];
    for (int c = 0; c < 3; ++c) sum[c] = upper[left + c] + upper[right + c] + lower[left + c] + lower[right + c];
    cb[x] = apply(m.cb, sum[0], sum[1], sum[2], fraction_bits + 2);
    cr[x] = apply(m.cr, sum[0], sum[1], sum[2], fraction_bits + 2);
  };
  for (int x = 0; x < width / 2; ++x) write(x, 2 * lanes * x, 2 * lanes * x + lanes);
  if (width % 2 != 0) write(width / 2, lanes * (width - 1), lanes * (width - 1));
}

/// Weights of one working pixel: calls visit(source, weight) for each source that shares area with it, in order.
template <typename Visit>
void for_each_tap(const AreaAxis& axis, int target, Visit visit) {
  const std::int32_t low = target * axis.cell;
  const std::int32_t high = low + axis.cell;
  auto i = static_cast<std::int32_t>(std::int64_t{target} * axis.source / axis.target);
  for (; i < axis.source && axis.start(i) < high; ++i) {
    const std::int32_t weight = std::min(axis.start(i + 1), high) - std::max(axis.start(i), low);
    if (weight > 0) visit(i, weight);
  }
}

AreaAxis make_axis(int source, int target, int cell) { return {source, target, cell}; }

bool has_size(const ImageView<std::uint8_t>& image, int width, int height) {
  return image.data != nullptr && image.width == width && image.height == height && image.stride >= width;
}

}  // namespace

Status Subsampler::configure(int frame_width, int frame_height, int work_width, int work_height) {
  if (work_width < 1 || work_height < 1 || frame_width < work_width || frame_height < work_height) {
    return Status::invalid_argument;
  }
  if (frame_width > max_frame_width || frame_height > max_frame_height) return Status::invalid_argument;
  const auto columns = static_cast<std::size_t>(work_width);
  const auto frame_columns = static_cast<std::size_t>(frame_width);
  if (memory_.first_column.size() < columns || memory_.weights.size() < 2 * columns + frame_columns ||
      memory_.column_sums.size() < 3 * frame_columns + 1 || memory_.unpacked.size() < 3 * frame_columns ||
      memory_.work_rows.size() < 2 * lanes * columns) {
    return Status::capacity;
  }

  const int cell_x = frame_width / std::gcd(frame_width, work_width);
  const int cell_y = frame_height / std::gcd(frame_height, work_height);
  wide_ = cell_x * cell_y > max_exact_cells;
  // Small ratios are taken several times: ScaleNarrow is the more exact the more cells there are.
  const int repeat = wide_ ? 1 : max_exact_cells / (cell_x * cell_y);
  horizontal_ = make_axis(frame_width, work_width, wide_ ? rounded_cell : cell_x * repeat);
  vertical_ = make_axis(frame_height, work_height, wide_ ? rounded_cell : cell_y);

  taps_ = 0;
  for (int x = 0; x < work_width; ++x) {
    int first = -1, last = 0;
    for_each_tap(horizontal_, x, [&](int i, int) {
      if (first < 0) first = i;
      last = i;
    });
    taps_ = std::max(taps_, last - first + 1);
  }
  std::fill(memory_.weights.begin(), memory_.weights.end(), std::uint16_t{0});
  for (int x = 0; x < work_width; ++x) {
    int first = -1;
    for_each_tap(horizontal_, x, [&](int i, int weight) {
      // At the right border the window is moved to the left, so that it never leaves the row.
      if (first < 0) first = std::min(i, frame_width - taps_);
      memory_.weights[static_cast<std::size_t>(x * taps_ + i - first)] = static_cast<std::uint16_t>(weight);
    });
    memory_.first_column[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(first);
  }
  configured_ = true;
  return Status::ok;
}

std::span<std::uint16_t> Subsampler::work_row(int index) {
  const auto size = static_cast<std::size_t>(lanes * horizontal_.target);
  return memory_.work_rows.subspan(size * static_cast<std::size_t>(index), size);
}

void Subsampler::make_work_row(const FrameView& frame, int y, std::uint16_t* out) {
  bool first = true;
  for_each_tap(vertical_, y, [&](int source, int weight) {
    const std::uint8_t* row = unpack_row(frame, source, memory_.unpacked.data());
    add_row(row, 3 * frame.width, weight, first, memory_.column_sums.data());
    first = false;
  });
  const ColumnTable table = {memory_.first_column.data(), memory_.weights.data(), horizontal_.target, taps_};
  if (wide_) {
    reduce_columns(memory_.column_sums.data(), table, ScaleWide{}, out);
  } else {
    reduce_columns(memory_.column_sums.data(), table, ScaleNarrow(horizontal_.cell * vertical_.cell), out);
  }
}

Status Subsampler::run(const FrameView& frame, Yuv420View out) {
  if (!configured_) return Status::not_ready;
  const int width = horizontal_.target;
  const int height = vertical_.target;
  if (frame.width != horizontal_.source || frame.height != vertical_.source) return Status::wrong_size;
  if (!has_size(out.y, width, height) || !has_size(out.cb, (width + 1) / 2, (height + 1) / 2) ||
      !has_size(out.cr, (width + 1) / 2, (height + 1) / 2)) {
    return Status::wrong_size;
  }
  if (frame.data == nullptr || frame.stride_bytes < frame.width * bytes_per_pixel(frame.format) ||
      (frame.format == PixelFormat::yuyv && frame.width % 2 != 0)) {
    return Status::invalid_argument;
  }

  const ColourMatrix matrix = colour_matrix(frame.format);
  for (int y = 0; y < height; y += 2) {
    std::uint16_t* upper = work_row(0).data();
    std::uint16_t* lower = upper;
    make_work_row(frame, y, upper);
    write_luma(upper, width, matrix.y, out.y.row(y));
    if (y + 1 < height) {
      lower = work_row(1).data();
      make_work_row(frame, y + 1, lower);
      write_luma(lower, width, matrix.y, out.y.row(y + 1));
    }
    write_chroma(upper, lower, width, matrix, out.cb.row(y / 2), out.cr.row(y / 2));
  }
  return Status::ok;
}

}  // namespace touchline
