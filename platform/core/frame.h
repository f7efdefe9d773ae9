// SPDX-License-Identifier: Apache-2.0
// A camera frame as the driver hands it over. The pipeline reads it in place; nothing is copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace touchline {

enum class PixelFormat : std::uint8_t {
  rgb24,   // R G B, 8 bit each
  bgr24,   // B G R, 8 bit each
  rgb565,  // little-endian 16 bit: red in the high 5 bits
  yuyv,    // Y0 Cb Y1 Cr, 4:2:2, limited range BT.601 (16..235), as cameras send it; width must be even
};

inline constexpr int max_frame_width = 1280;  // the largest camera of the data sets
inline constexpr int max_frame_height = 1024;

constexpr bool is_known(PixelFormat f) { return f <= PixelFormat::yuyv; }
constexpr int bytes_per_pixel(PixelFormat f) { return f == PixelFormat::rgb24 || f == PixelFormat::bgr24 ? 3 : 2; }

struct FrameView {
  PixelFormat format = PixelFormat::rgb24;
  const std::uint8_t* data = nullptr;
  int width = 0;
  int height = 0;
  int stride_bytes = 0;  // >= width * bytes_per_pixel(format)
};

}  // namespace touchline
