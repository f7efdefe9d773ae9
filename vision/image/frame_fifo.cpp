// SPDX-License-Identifier: Apache-2.0
// The mean over held frames, written over the oldest of them. Up to eight bytes are summed in 16 bit and divided by one
// multiplication, exactly.
#include "vision/image/frame_fifo.h"

#include <algorithm>

namespace touchline {
namespace {

using Plane = ImageView<std::uint8_t> Yuv420View::*;
using Rows = std::array<const std::uint8_t*, max_fifo_depth>;

/// out = (sum of N rows + N / 2) / N. The reciprocal is rounded up: with sums below 2^11 and N <= 8 the quotient is
/// exact.
template <int N>
void mean_row(const Rows& rows, int width, std::uint8_t* out) {
  constexpr std::uint32_t reciprocal = (65536U + N - 1) / N;
  constexpr int part_px = 64;  // a part is read whole before it is written
  std::array<std::uint8_t, part_px> part;
  for (int first = 0; first < width; first += part_px) {
    const int count = std::min(part_px, width - first);
    for (int x = 0; x < count; ++x) {
      std::uint16_t sum = N / 2;
      for (int i = 0; i < N; ++i) sum = static_cast<std::uint16_t>(sum + rows[static_cast<std::size_t>(i)][first + x]);
      part[static_cast<std::size_t>(x)] = static_cast<std::uint8_t>((sum * reciprocal) >> 16);
    }
    std::copy_n(part.begin(), count, out + first);
  }
}

void mean_row(const Rows& rows, int frames, int width, std::uint8_t* out) {
  switch (frames) {
    case 2: return mean_row<2>(rows, width, out);
    case 3: return mean_row<3>(rows, width, out);
    case 4: return mean_row<4>(rows, width, out);
    case 5: return mean_row<5>(rows, width, out);
    case 6: return mean_row<6>(rows, width, out);
    case 7: return mean_row<7>(rows, width, out);
    default: return mean_row<8>(rows, width, out);
  }
}

void mean_plane(std::span<const Yuv420View> frames, Plane plane, const MeanOfFour& mean_of_four,
                const ImageView<std::uint8_t>& out) {
  // Rows without gaps between them, which is the usual thing, are one long row.
  const bool in_one_piece =
      std::all_of(frames.begin(), frames.end(), [&](const Yuv420View& f) { return (f.*plane).stride == out.width; }) &&
      out.stride == out.width;
  const int width = in_one_piece ? out.width * out.height : out.width;
  for (int y = 0; y < (in_one_piece ? 1 : out.height); ++y) {
    Rows rows{};
    for (std::size_t i = 0; i < frames.size(); ++i) rows[i] = (frames[i].*plane).row(y);
    if (frames.size() == 4 && mean_of_four != nullptr) {
      mean_of_four(rows.data(), width, out.row(y));
    } else {
      mean_row(rows, static_cast<int>(frames.size()), width, out.row(y));
    }
  }
}

}  // namespace

FrameFifo::FrameFifo(std::span<const Yuv420View> slots, const Kernels& kernels)
    : depth_(slots.size()), mean_of_four_(kernels.mean_of_four) {
  assert(!slots.empty() && slots.size() <= slots_.size());
  std::copy(slots.begin(), slots.end(), slots_.begin());
}

void FrameFifo::push() {
  next_ = (next_ + 1) % depth();
  size_ = std::min(size_ + 1, depth());
}

void FrameFifo::reset() {
  next_ = 0;
  size_ = 0;
  frames_in_mean_ = 0;
}

ConstYuv420View FrameFifo::mean_of_still(std::span<const bool> still) {
  assert(size_ > 0);
  std::array<Yuv420View, max_fifo_depth> frames{};
  std::size_t count = 0;
  for (int age = 0; age < size_; ++age) {
    const auto i = static_cast<std::size_t>(age);
    if (age > 0 && (i >= still.size() || !still[i])) continue;
    frames[count++] = slots_[static_cast<std::size_t>((next_ + depth() - 1 - age) % depth())];
  }
  frames_in_mean_ = static_cast<int>(count);
  if (count == 1) return frames[0];
  const std::span<const Yuv420View> used = std::span<const Yuv420View>(frames).first(count);
  const Yuv420View mean = next_slot();
  mean_plane(used, &Yuv420View::y, mean_of_four_, mean.y);
  mean_plane(used, &Yuv420View::cb, mean_of_four_, mean.cb);
  mean_plane(used, &Yuv420View::cr, mean_of_four_, mean.cr);
  return mean;
}

}  // namespace touchline
