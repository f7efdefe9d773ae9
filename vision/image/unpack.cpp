// SPDX-License-Identifier: Apache-2.0
// Unpacking of camera rows. 5 and 6 bit channels repeat their high bits, so that full scale becomes 255.
#include "vision/image/unpack.h"

namespace touchline {
namespace {

void unpack_rgb565(const std::uint8_t* row, int first, int width, std::uint8_t* out) {
  for (int x = first; x < width; ++x) {
    const unsigned pixel = row[2 * x] | static_cast<unsigned>(row[2 * x + 1]) << 8;
    const unsigned red = pixel >> 11, green = (pixel >> 5) & 63U, blue = pixel & 31U;
    out[3 * x] = static_cast<std::uint8_t>(red << 3 | red >> 2);
    out[3 * x + 1] = static_cast<std::uint8_t>(green << 2 | green >> 4);
    out[3 * x + 2] = static_cast<std::uint8_t>(blue << 3 | blue >> 2);
  }
}

void unpack_yuyv(const std::uint8_t* row, int first, int width, std::uint8_t* out) {
  for (int x = first; x + 1 < width; x += 2) {
    const std::uint8_t* pair = row + 2 * x;
    for (int i = 0; i < 2; ++i) {
      out[3 * (x + i)] = pair[2 * i];
      out[3 * (x + i) + 1] = pair[1];
      out[3 * (x + i) + 2] = pair[3];
    }
  }
}

}  // namespace

const std::uint8_t* unpack_row(const FrameView& frame, int y, std::uint8_t* buffer, const UnpackKernels& kernels) {
  const std::uint8_t* row = frame.data + static_cast<std::ptrdiff_t>(y) * frame.stride_bytes;
  if (frame.format == PixelFormat::rgb565) {
    const int done = kernels.rgb565 != nullptr ? kernels.rgb565(row, frame.width, buffer) : 0;
    unpack_rgb565(row, done, frame.width, buffer);
    return buffer;
  }
  if (frame.format == PixelFormat::yuyv) {
    const int done = kernels.yuyv != nullptr ? kernels.yuyv(row, frame.width, buffer) : 0;
    unpack_yuyv(row, done, frame.width, buffer);
    return buffer;
  }
  return row;
}

}  // namespace touchline
