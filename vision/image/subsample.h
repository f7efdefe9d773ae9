// SPDX-License-Identifier: Apache-2.0
// From the camera's frame to the working image: area weighting, every source pixel counts with the area that it shares
// with a working pixel (paper section IV-A), and the change of colour space, in one pass over the frame.
#pragma once

#include <array>
#include <span>

#include "platform/core/status.h"
#include "vision/image/frame.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"

namespace touchline {

/// Memory that a Subsampler works in: its tables, which have to stay, and rows, which need not.
struct SubsampleMemory {
  std::span<std::uint16_t> first_column;  // a working column
  std::span<std::uint16_t> weights;       // 2 a working column and 1 a frame column
  std::span<std::uint16_t> column_sums;   // 3 a frame column, and a vector
  std::span<std::uint8_t> unpacked;       // 3 a frame column, of unpacked_rows rows
  std::span<std::uint16_t> work_rows;     // 10 a working column, with columns rounded up to whole vectors
};
inline constexpr int subsample_lanes = 8;        // of a vector
inline constexpr std::size_t unpacked_rows = 4;  // of the camera, for a row of chroma where it is halved
constexpr int whole_lanes(int columns) { return (columns + subsample_lanes - 1) / subsample_lanes * subsample_lanes; }

/// Storage for frames of up to FrameWidth and working images of up to WorkWidth columns: what has to stay,
template <int FrameWidth, int WorkWidth>
struct SubsampleTables {
  std::array<std::uint16_t, std::size_t{WorkWidth}> first_column{};
  std::array<std::uint16_t, 2 * std::size_t{WorkWidth} + std::size_t{FrameWidth}> weights{};
};
/// and what need not.
template <int FrameWidth, int WorkWidth>
struct SubsampleRows {
  std::array<std::uint16_t, 3 * std::size_t{FrameWidth} + std::size_t{subsample_lanes}> column_sums{};
  std::array<std::uint8_t, unpacked_rows * 3 * std::size_t{FrameWidth}> unpacked{};
  std::array<std::uint16_t, 10 * std::size_t{whole_lanes(WorkWidth)}> work_rows{};
};
template <int FrameWidth, int WorkWidth>
SubsampleMemory subsample_memory(SubsampleTables<FrameWidth, WorkWidth>& tables,
                                 SubsampleRows<FrameWidth, WorkWidth>& rows) {
  return {tables.first_column, tables.weights, rows.column_sums, rows.unpacked, rows.work_rows};
}
/// Both.
template <int FrameWidth, int WorkWidth>
struct SubsampleStorage {
  SubsampleTables<FrameWidth, WorkWidth> tables;
  SubsampleRows<FrameWidth, WorkWidth> rows;
  [[nodiscard]] SubsampleMemory memory() { return subsample_memory(tables, rows); }
};

/// One axis of the area weighting. Source pixel i covers start(i)..start(i + 1), working pixel o covers
/// o * cell..(o + 1) * cell, and the overlap is the weight; the weights of a working pixel sum to `cell` exactly.
struct AreaAxis {
  std::int32_t source = 1;
  std::int32_t target = 1;
  std::int32_t cell = 1;
  [[nodiscard]] std::int32_t start(std::int32_t i) const {
    return static_cast<std::int32_t>((std::int64_t{i} * target * cell + source / 2) / source);
  }
};

/// Where the reduced ratios of both axes multiply to 257 or less (752x480 to 320x240: 47/20 and 2/1; all usual
/// cameras), the weights are exact; else each is rounded to 1/256 of a working pixel, in such a way that they still sum
/// exactly. A frame of one colour becomes a working image of one colour, that of the integer formula below, for any
/// size.
///
/// Colours: full-range BT.601 as in JPEG, with 14-bit coefficients:
///   Y  = (4899 R + 9617 G + 1868 B) / 16384
///   Cb = 128 + (-2765 R - 5427 G + 8192 B) / 16384
///   Cr = 128 + (8192 R - 6860 G - 1332 B) / 16384
/// rounded once, after the weighting, and clamped to 0..255. YUYV is stretched from limited range (luma 255/219, chroma
/// 255/224).
class Subsampler {
 public:
  explicit Subsampler(const SubsampleMemory& memory) : memory_(memory) {}

  /// invalid_argument: a size below 1, a frame larger than max_frame_width x max_frame_height or smaller than the
  /// working image. capacity: the memory is for smaller images. The old configuration then stays. `kernels` are
  /// used where they fit the sizes; they do not change the result.
  Status configure(int frame_width, int frame_height, int work_width, int work_height,
                   const Kernels& kernels = portable_kernels());

  /// not_ready: not configured. wrong_size: `frame` or `out` has another size than configured. invalid_argument: no
  /// data, a stride that is too short, or YUYV of odd width. In all these cases `out` is as it was.
  Status run(const FrameView& frame, Yuv420View out);

 private:
  /// One working row as three rows of channels, in 8.6 bit.
  struct Channels {
    std::uint16_t* channel[3] = {};
  };
  void set_weights();
  void set_kernel_weights();
  [[nodiscard]] bool fits_kernels(const Kernels& kernels) const;
  void run_kernels(const FrameView& frame, const Yuv420View& out) const;
  void unpack_and_run_kernels(const FrameView& frame, const Yuv420View& out) const;
  void keep_size(const FrameView& frame, const Yuv420View& out) const;
  [[nodiscard]] Channels work_row(int index) const;
  void make_work_row(const FrameView& frame, int y, const Channels& out);

  SubsampleMemory memory_;
  AreaAxis horizontal_;
  AreaAxis vertical_;
  int taps_ = 0;    // most source columns that a working column needs
  int period_ = 0;  // the weights of columns repeat after so many, and are kept in pairs; 0: each column has its own
  std::uint16_t scale_ = 0;           // from sums to 8.6 bit, in 1/65536
  HalveFrame halve_frame_ = nullptr;  // where the sizes fit it
  SubsampleKernels loops_;
  UnpackKernels unpack_;
  ChangeRows change_rows_ = nullptr;
  bool wide_ = false;  // sums need 32 bit: the weights are rounded
  bool configured_ = false;
};

}  // namespace touchline
