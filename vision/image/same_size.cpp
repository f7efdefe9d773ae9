// SPDX-License-Identifier: Apache-2.0
#include "vision/image/same_size.h"

#include <algorithm>

#include "vision/image/colour_matrix.h"

namespace touchline {
namespace {

/// One coefficient of a diagonal matrix; `halves` is the sample times two.
class Stretch {
 public:
  Stretch(std::int16_t factor, std::int32_t offset) : factor_(factor), offset_(offset * 2 + (1 << colour_bits)) {}
  [[nodiscard]] std::uint8_t operator()(int halves) const {
    return static_cast<std::uint8_t>(
        std::clamp<std::int32_t>((factor_ * halves + offset_) >> (colour_bits + 1), 0, 255));
  }

 private:
  std::int32_t factor_;
  std::int32_t offset_;  // rounds, too
};

}  // namespace

void stretch_yuyv(const FrameView& frame, const Yuv420View& out) {
  const ColourMatrix matrix = colour_matrix(PixelFormat::yuyv);
  const Stretch luma(matrix.y.a, matrix.y.offset);
  const Stretch blue(matrix.cb.b, matrix.cb.offset);
  const Stretch red(matrix.cr.c, matrix.cr.offset);
  for (int y = 0; y < frame.height; y += 2) {
    const std::uint8_t* upper = frame.data + static_cast<std::ptrdiff_t>(y) * frame.stride_bytes;
    const std::uint8_t* lower = upper + frame.stride_bytes;
    std::uint8_t* luma_upper = out.y.row(y);
    std::uint8_t* luma_lower = out.y.row(y + 1);
    std::uint8_t* cb = out.cb.row(y / 2);
    std::uint8_t* cr = out.cr.row(y / 2);
    for (int x = 0; x < frame.width; x += 2, upper += 4, lower += 4) {
      luma_upper[x] = luma(2 * upper[0]);
      luma_upper[x + 1] = luma(2 * upper[2]);
      luma_lower[x] = luma(2 * lower[0]);
      luma_lower[x + 1] = luma(2 * lower[2]);
      cb[x / 2] = blue(upper[1] + lower[1]);
      cr[x / 2] = red(upper[3] + lower[3]);
    }
  }
}

}  // namespace touchline
