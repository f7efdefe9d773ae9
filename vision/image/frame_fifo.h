// SPDX-License-Identifier: Apache-2.0
// The last few working images and their mean (paper section IV-A): newest in, oldest out. Frames that moved are left
// out. The mean takes the place of the oldest frame, whose last use it was.
#pragma once

#include <array>
#include <span>

#include "vision/image/image_view.h"
#include "vision/image/kernels.h"

namespace touchline {

inline constexpr int max_fifo_depth = 8;

/// Storage of one working image.
template <int W, int H>
struct Yuv420Image {
  Image<std::uint8_t, W, H> y;
  Image<std::uint8_t, (W + 1) / 2, (H + 1) / 2> cb, cr;
  [[nodiscard]] Yuv420View view(int width = W, int height = H) {
    const int chroma_width = (width + 1) / 2;
    const int chroma_height = (height + 1) / 2;
    return {y.view(width, height), cb.view(chroma_width, chroma_height), cr.view(chroma_width, chroma_height)};
  }
};

/// Use per frame: write into next_slot(), then push(), then mean_of_still().
class FrameFifo {
 public:
  /// No slots yet: only to be assigned to.
  FrameFifo() = default;
  /// `slots`: 1 to max_fifo_depth images of one size.
  explicit FrameFifo(std::span<const Yuv420View> slots, const Kernels& kernels = portable_kernels());

  /// The slot of the oldest frame (or of none yet), and of the last mean: write the new frame there.
  [[nodiscard]] Yuv420View next_slot() const { return slots_[static_cast<std::size_t>(next_)]; }
  /// The frame in next_slot() is the newest now.
  void push();
  /// Forgets all frames, as after a fall.
  void reset();
  /// Frames held: 0..depth.
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] int depth() const { return static_cast<int>(depth_); }

  /// The mean over the newest frame and those of `still` that are true: still[i] says that the i-th newest frame (0 is
  /// the newest, always in) was taken from where the newest was; elements that are missing count as false. Each sample
  /// is (sum + n / 2) / n, so halves round up. The mean of one frame is that frame itself, without a copy; any other is
  /// written into next_slot(). Valid until the next write to a slot. Once after each push().
  ConstYuv420View mean_of_still(std::span<const bool> still);
  /// How many frames the last mean_of_still() took.
  [[nodiscard]] int frames_in_mean() const { return frames_in_mean_; }

 private:
  std::array<Yuv420View, max_fifo_depth> slots_{};
  std::size_t depth_ = 0;
  MeanOfFour mean_of_four_ = nullptr;
  int next_ = 0;
  int size_ = 0;
  int frames_in_mean_ = 0;
};

}  // namespace touchline
