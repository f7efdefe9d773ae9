// SPDX-License-Identifier: Apache-2.0
// What both ways of Canny share: the memory of their rolling rows, and the scale of the gradient.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "vision/image/canny.h"

namespace touchline {

/// The blur is not divided by its 16, so that nothing is rounded: magnitudes are 16 times those of the thresholds.
inline constexpr int blur_scale = 16;

/// Rows by number, all zero at first; index 0 of each is column 0, with canny_row_margin before it.
class CannyRows {
 public:
  CannyRows(CannyMemory memory, int width) : rows_(memory.rows), stride_(canny_row_stride(width)) {
    assert(rows_.size() >= static_cast<std::size_t>(canny_rows * stride_));
    std::fill(rows_.begin(), rows_.begin() + canny_rows * stride_, std::uint16_t{0});
  }
  [[nodiscard]] std::uint16_t* row(int i) const { return rows_.data() + i * stride_ + canny_row_margin; }
  /// Signed and unsigned types of one width may look at the same memory.
  [[nodiscard]] std::int16_t* signed_row(int i) const { return reinterpret_cast<std::int16_t*>(row(i)); }

 private:
  std::span<std::uint16_t> rows_;
  int stride_;
};

}  // namespace touchline
