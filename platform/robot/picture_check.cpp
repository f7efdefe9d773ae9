// SPDX-License-Identifier: Apache-2.0
#include "platform/robot/picture_check.h"

#include <cstddef>

namespace touchline {
namespace {

constexpr int samples_a_side = 32;

/// Green of the RGB formats, luma of YUYV with black at 0: near enough for a question of black or not.
int brightness(PixelFormat format, const std::uint8_t* pixel) {
  switch (format) {
    case PixelFormat::rgb24:
    case PixelFormat::bgr24: return pixel[1];
    case PixelFormat::rgb565: return ((pixel[1] & 7) << 5) | ((pixel[0] & 0xE0) >> 3);
    case PixelFormat::yuyv: return pixel[0] > 16 ? pixel[0] - 16 : 0;
  }
  return 0;
}

}  // namespace

std::uint8_t brightest_sample(const FrameView& frame) {
  int brightest = 0;
  if (frame.data == nullptr || frame.width <= 0 || frame.height <= 0) return 0;
  for (int j = 0; j < samples_a_side; ++j) {
    const int v = (2 * j + 1) * frame.height / (2 * samples_a_side);
    const std::uint8_t* row = frame.data + static_cast<std::ptrdiff_t>(v) * frame.stride_bytes;
    for (int i = 0; i < samples_a_side; ++i) {
      const int u = (2 * i + 1) * frame.width / (2 * samples_a_side);
      const int value = brightness(frame.format, row + static_cast<std::ptrdiff_t>(u) * bytes_per_pixel(frame.format));
      brightest = value > brightest ? value : brightest;
    }
  }
  return static_cast<std::uint8_t>(brightest);
}

}  // namespace touchline
