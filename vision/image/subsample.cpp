// SPDX-License-Identifier: Apache-2.0
// Area weighting, separable: rows are summed first, in whole interleaved rows, then columns, then colours are changed.
// Every format is unpacked to rows of three interleaved bytes, so that there is one copy of each loop.
#include "vision/image/subsample.h"

#include <algorithm>
#include <numeric>

#include "vision/image/colour_matrix.h"
#include "vision/image/lanes.h"
#include "vision/image/same_size.h"
#include "vision/image/unpack.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {

/// Three channels and one lane without a meaning: half a vector a pixel.
constexpr int pixel_lanes = 4;

/// 255 * 257 is the largest sum that 16 bit hold.
constexpr int max_exact_cells = 257;
constexpr int rounded_cell = 256;

constexpr int fraction_bits = subsample_fraction_bits;

/// Two rows of the same weight at once: the usual 480 to 240.
void set_two_rows(const std::uint8_t* a, const std::uint8_t* b, int count, int weight, std::uint16_t* sums) {
  const auto w = static_cast<std::uint16_t>(weight);
  for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>((a[i] + b[i]) * w);
}

struct ColumnTable {
  const std::uint16_t* first = nullptr;
  const std::uint16_t* weights = nullptr;
  int columns = 0;
  int taps = 0;
  int period = 0;
};

/// Weighted sums of neighbouring pixels, two working columns at a time.
template <int Taps>
void reduce_pairs(const std::uint16_t* sums, ColumnTable table, std::uint16_t* out) {
  for (int x = 0; x < table.columns;) {
    const std::uint16_t* weights = table.weights;
    const int end = std::min(x + table.period, table.columns);
    for (; x < end; x += 2, weights += 2 * pixel_lanes * Taps) {
      const std::uint16_t* left = sums + 3 * table.first[x];
      const std::uint16_t* right = sums + 3 * table.first[x + 1];
      U16x8 total = load_halves(left, right) * load_lanes(weights);
      for (int t = 1; t < Taps; ++t) {
        total += load_halves(left + 3 * t, right + 3 * t) * load_lanes(weights + 2 * pixel_lanes * t);
      }
      store_lanes(total, out + pixel_lanes * x);
    }
  }
}
constexpr int max_pair_taps = 6;  // ratios up to 5

void reduce_pairs(const std::uint16_t* sums, ColumnTable table, std::uint16_t* out) {
  switch (table.taps) {
    case 1: return reduce_pairs<1>(sums, table, out);
    case 2: return reduce_pairs<2>(sums, table, out);
    case 3: return reduce_pairs<3>(sums, table, out);
    case 4: return reduce_pairs<4>(sums, table, out);
    case 5: return reduce_pairs<5>(sums, table, out);
    default: return reduce_pairs<max_pair_taps>(sums, table, out);
  }
}

/// From pixels to channels, eight pixels at a time.
void split_channels(const std::uint16_t* pixels, int columns, std::uint16_t* c0, std::uint16_t* c1, std::uint16_t* c2) {
  for (int x = 0; x < columns; x += subsample_lanes, pixels += pixel_lanes * subsample_lanes) {
    const U16x8 p01 = load_lanes(pixels);
    const U16x8 p23 = load_lanes(pixels + 8);
    const U16x8 p45 = load_lanes(pixels + 16);
    const U16x8 p67 = load_lanes(pixels + 24);
    const U16x8 p04 = interleave_low(p01, p45);
    const U16x8 p15 = interleave_high(p01, p45);
    const U16x8 p26 = interleave_low(p23, p67);
    const U16x8 p37 = interleave_high(p23, p67);
    const U16x8 even01 = interleave_low(p04, p26);  // channels 0 and 1 of pixels 0, 2, 4, 6
    const U16x8 odd01 = interleave_low(p15, p37);
    const U16x8 even2 = interleave_high(p04, p26);
    const U16x8 odd2 = interleave_high(p15, p37);
    store_lanes(interleave_low(even01, odd01), c0 + x);
    store_lanes(interleave_high(even01, odd01), c1 + x);
    store_lanes(interleave_low(even2, odd2), c2 + x);
  }
}

/// From 16-bit sums to 8.6 bit by one multiplication. Without vector registers the high word of a long product: there,
/// g++ 12.2 makes a wrong multiplication out of the first loop (its bug 106322).
void scale_row(std::uint16_t* row, int columns, std::uint16_t factor) {
  if constexpr (vector_registers) {
    for (int x = 0; x < columns; ++x) row[x] = static_cast<std::uint16_t>((std::uint32_t{row[x]} * factor) >> 16);
  } else {
    const std::uint64_t high = std::uint64_t{factor} << 16;
    for (int x = 0; x < columns; ++x) row[x] = static_cast<std::uint16_t>((row[x] * high) >> 32);
  }
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

/// The most sources that a target takes, from its first to its last.
int most_taps(const AreaAxis& axis) {
  int taps = 0;
  for (int x = 0; x < axis.target; ++x) {
    int first = -1, last = 0;
    for_each_tap(axis, x, [&](int i, int) {
      if (first < 0) first = i;
      last = i;
    });
    taps = std::max(taps, last - first + 1);
  }
  return taps;
}

int most_weight(const AreaAxis& axis) {
  int most = 0;
  for (int x = 0; x < axis.target; ++x) for_each_tap(axis, x, [&](int, int weight) { most = std::max(most, weight); });
  return most;
}

bool has_size(const ImageView<std::uint8_t>& image, int width, int height) {
  return image.data != nullptr && image.width == width && image.height == height && image.stride >= width;
}

}  // namespace

Status Subsampler::configure(int frame_width, int frame_height, int work_width, int work_height,
                             const Kernels& kernels) {
  if (work_width < 1 || work_height < 1 || frame_width < work_width || frame_height < work_height) {
    return Status::invalid_argument;
  }
  if (frame_width > max_frame_width || frame_height > max_frame_height) return Status::invalid_argument;
  const auto columns = static_cast<std::size_t>(work_width);
  const auto frame_columns = static_cast<std::size_t>(frame_width);
  if (memory_.first_column.size() < columns || memory_.weights.size() < 2 * columns + frame_columns ||
      memory_.column_sums.size() < 3 * frame_columns + subsample_lanes ||
      memory_.unpacked.size() < unpacked_rows * 3 * frame_columns ||
      memory_.work_rows.size() < static_cast<std::size_t>(10 * whole_lanes(work_width))) {
    return Status::capacity;
  }

  const int cell_x = frame_width / std::gcd(frame_width, work_width);
  const int cell_y = frame_height / std::gcd(frame_height, work_height);
  wide_ = cell_x * cell_y > max_exact_cells;
  // Small ratios are taken several times: scale_row() is the more exact the more cells there are.
  const int repeat = wide_ ? 1 : max_exact_cells / (cell_x * cell_y);
  horizontal_ = {frame_width, work_width, wide_ ? rounded_cell : cell_x * repeat};
  vertical_ = {frame_height, work_height, wide_ ? rounded_cell : cell_y};
  // Rounded up, as products are rounded down: exact for a sum of equal samples, where the error is below
  // cells * 255 / 65536 < 1.
  const int cells = horizontal_.cell * vertical_.cell;
  scale_ = static_cast<std::uint16_t>(((1 << (16 + fraction_bits)) + cells - 1) / cells);
  taps_ = most_taps(horizontal_);
  // Pairs of columns need an even period, kernels one of four.
  const int period = std::lcm(work_width / std::gcd(frame_width, work_width), 4);
  const bool pairs = !wide_ && work_width % 2 == 0 && taps_ <= max_pair_taps &&
                     static_cast<std::size_t>(period * taps_ * pixel_lanes) <= memory_.weights.size();
  period_ = pairs ? period : 0;
  set_weights();
  halve_frame_ = fits_kernels(kernels) ? kernels.halve_frame : nullptr;
  loops_ = kernels.subsample;
  change_rows_ = kernels.change_rows;
  unpack_ = kernels.unpack;
  if (halve_frame_ != nullptr) set_kernel_weights();
  configured_ = true;
  return Status::ok;
}

void Subsampler::set_weights() {
  std::fill(memory_.weights.begin(), memory_.weights.end(), std::uint16_t{0});
  for (int x = 0; x < horizontal_.target; ++x) {
    int first = -1;
    for_each_tap(horizontal_, x, [&](int i, int weight) {
      if (first < 0) {
        // The last window may reach beyond the row: pairs read a column of no weight there, others move to the left.
        first = period_ != 0 ? i : std::min<std::int32_t>(i, horizontal_.source - taps_);
        memory_.first_column[static_cast<std::size_t>(x)] = static_cast<std::uint16_t>(first);
      }
      const int tap = i - first;
      if (period_ == 0) {
        memory_.weights[static_cast<std::size_t>(x * taps_ + tap)] = static_cast<std::uint16_t>(weight);
      } else if (x < period_) {
        const int vector = x / 2 * taps_ + tap;
        const int lane = 2 * pixel_lanes * vector + x % 2 * pixel_lanes;
        std::fill_n(memory_.weights.begin() + lane, 3, static_cast<std::uint16_t>(weight));
      }
    });
  }
}

namespace {
constexpr int kernel_taps = 4;
constexpr int kernel_bytes = 16;  // of weights a working column
/// The weights of the kernels lie behind those of the pairs.
std::size_t pair_weights(int period, int taps) { return static_cast<std::size_t>(period * taps * pixel_lanes); }
}  // namespace

bool Subsampler::fits_kernels(const Kernels& kernels) const {
  return kernels.halve_frame != nullptr && period_ != 0 && period_ % 4 == 0 && taps_ <= kernel_taps &&
         horizontal_.target % 8 == 0 && vertical_.target % 2 == 0 && vertical_.source == 2 * vertical_.target &&
         vertical_.cell == 2 && 2 * horizontal_.cell <= max_exact_cells &&
         horizontal_.source <= 4 * horizontal_.target && most_weight(horizontal_) < 128 &&
         pair_weights(period_, taps_) + static_cast<std::size_t>(period_ * kernel_bytes / 2) <= memory_.weights.size();
}

void Subsampler::set_kernel_weights() {
  auto* bytes = reinterpret_cast<std::int8_t*>(memory_.weights.data() + pair_weights(period_, taps_));
  std::fill_n(bytes, period_ * kernel_bytes, std::int8_t{0});
  for (int x = 0; x < std::min<std::int32_t>(period_, horizontal_.target); ++x) {
    const int first = memory_.first_column[static_cast<std::size_t>(x)];
    for_each_tap(horizontal_, x, [&](int i, int weight) {
      const int tap = i - first;
      for (int c = 0; c < 3; ++c) {
        bytes[kernel_bytes * x + tap / 2 * (kernel_bytes / 2) + 2 * c + tap % 2] = static_cast<std::int8_t>(weight);
      }
    });
  }
}

void Subsampler::run_kernels(const FrameView& frame, const Yuv420View& out) const {
  HalvedFrame halved;
  halved.source = frame.data;
  halved.source_stride = frame.stride_bytes;
  halved.source_bytes = 3 * frame.width;
  halved.first_column = memory_.first_column.data();
  halved.weights = reinterpret_cast<const std::int8_t*>(memory_.weights.data() + pair_weights(period_, taps_));
  halved.columns = horizontal_.target;
  halved.rows = out.y.height;
  halved.period = period_;
  halved.scale = scale_;
  halved.matrix = colour_matrix(frame.format);
  halved.y = out.y.data;
  halved.cb = out.cb.data;
  halved.cr = out.cr.data;
  halved.y_stride = out.y.stride;
  halved.cb_stride = out.cb.stride;
  halved.cr_stride = out.cr.stride;
  halve_frame_(halved);
}

/// As many rows as there is room for, in whole rows of chroma: four rows of the camera each.
void Subsampler::unpack_and_run_kernels(const FrameView& frame, const Yuv420View& out) const {
  const int row_bytes = 3 * frame.width;
  constexpr int step = static_cast<int>(unpacked_rows);
  const int room = static_cast<int>(memory_.unpacked.size()) / row_bytes / step * step;
  std::uint8_t* const rows = memory_.unpacked.data();
  for (int first = 0; first < frame.height; first += room) {
    FrameView part = frame;
    part.height = std::min(room, frame.height - first);
    part.data = rows;
    part.stride_bytes = row_bytes;
    for (int y = 0; y < part.height; ++y) (void)unpack_row(frame, first + y, rows + y * row_bytes, unpack_);
    Yuv420View to = out;
    to.y.data += first / 2 * out.y.stride;
    to.cb.data += first / 4 * out.cb.stride;
    to.cr.data += first / 4 * out.cr.stride;
    to.y.height = part.height / 2;
    run_kernels(part, to);
  }
}

void Subsampler::keep_size(const FrameView& frame, const Yuv420View& out) const {
  if (frame.format == PixelFormat::yuyv) {
    stretch_yuyv(frame, out);
    return;
  }
  const std::span<std::uint16_t> sums = memory_.column_sums;  // room for two rows that are unpacked
  change_frame(frame, change_rows_, {reinterpret_cast<std::uint8_t*>(sums.data()), 2 * sums.size()}, out);
}

/// Rows 0 and 1 are working rows; row -1, in place of the interleaved pixels, which are used up by then, takes chroma.
Subsampler::Channels Subsampler::work_row(int index) const {
  const int columns = whole_lanes(horizontal_.target);
  const int offset = index < 0 ? 0 : (pixel_lanes + 3 * index) * columns;
  std::uint16_t* row = memory_.work_rows.data() + offset;
  return {{row, row + columns, row + 2 * columns}};
}

void Subsampler::make_work_row(const FrameView& frame, int y, const Channels& out) {
  std::uint16_t* sums = memory_.column_sums.data();
  const int samples = 3 * frame.width;
  if (needs_no_unpacking(frame.format) && vertical_.source == 2 * vertical_.target && vertical_.cell % 2 == 0) {
    set_two_rows(unpack_row(frame, 2 * y, nullptr), unpack_row(frame, 2 * y + 1, nullptr), samples, vertical_.cell / 2,
                 sums);
  } else {
    bool first = true;
    for_each_tap(vertical_, y, [&](int source, int weight) {
      loops_.add_row(unpack_row(frame, source, memory_.unpacked.data(), unpack_), samples, weight, first, sums);
      first = false;
    });
  }
  const ColumnTable table = {memory_.first_column.data(), memory_.weights.data(), horizontal_.target, taps_, period_};
  std::uint16_t* pixels = memory_.work_rows.data();
  if (period_ != 0) {
    reduce_pairs(sums, table, pixels);
  } else {
    loops_.reduce_columns({sums, frame.width, table.first, table.weights, table.columns, table.taps, horizontal_.cell,
                           wide_ ? 16 - fraction_bits : 0, pixels});
  }
  split_channels(pixels, horizontal_.target, out.channel[0], out.channel[1], out.channel[2]);
  if (!wide_) scale_row(out.channel[0], 3 * whole_lanes(horizontal_.target), scale_);
}

Status Subsampler::run(const FrameView& frame, Yuv420View out) {
  if (!configured_) return Status::not_ready;
  const int width = horizontal_.target;
  const int height = vertical_.target;
  const int chroma_width = (width + 1) / 2;
  const int chroma_height = (height + 1) / 2;
  if (frame.width != horizontal_.source || frame.height != vertical_.source) return Status::wrong_size;
  if (!has_size(out.y, width, height) || !has_size(out.cb, chroma_width, chroma_height) ||
      !has_size(out.cr, chroma_width, chroma_height)) {
    return Status::wrong_size;
  }
  if (frame.data == nullptr || !is_known(frame.format) ||
      frame.stride_bytes < frame.width * bytes_per_pixel(frame.format) ||
      (frame.format == PixelFormat::yuyv && frame.width % 2 != 0)) {
    return Status::invalid_argument;
  }

  if (frame.width == width && frame.height == height && width % 2 == 0 && height % 2 == 0) {
    keep_size(frame, out);
    return Status::ok;
  }
  if (halve_frame_ != nullptr) {
    needs_no_unpacking(frame.format) ? run_kernels(frame, out) : unpack_and_run_kernels(frame, out);
    return Status::ok;
  }
  const ColourMatrix matrix = colour_matrix(frame.format);
  const auto change = [this](const Channels& row, int columns, const ColourRow& m, std::uint8_t* to) {
    loops_.change_colour({{row.channel[0], row.channel[1], row.channel[2]}, columns}, m, to);
  };
  const Channels upper = work_row(0);
  const Channels chroma = work_row(-1);
  for (int y = 0; y < height; y += 2) {
    make_work_row(frame, y, upper);
    change(upper, width, matrix.y, out.y.row(y));
    Channels lower = upper;
    if (y + 1 < height) {
      lower = work_row(1);
      make_work_row(frame, y + 1, lower);
      change(lower, width, matrix.y, out.y.row(y + 1));
    }
    for (int c = 0; c < 3; ++c) loops_.halve(upper.channel[c], lower.channel[c], width, chroma.channel[c]);
    change(chroma, chroma_width, matrix.cb, out.cb.row(y / 2));
    change(chroma, chroma_width, matrix.cr, out.cr.row(y / 2));
  }
  return Status::ok;
}

}  // namespace touchline
