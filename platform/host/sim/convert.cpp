// SPDX-License-Identifier: Apache-2.0
// RGB24 to the other formats a camera driver may deliver; YUYV by BT.601, limited range.
#include <algorithm>

#include "platform/host/sim/renderer.h"

namespace touchline::sim {
namespace {

std::uint8_t byte(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

int luma(const std::uint8_t* p) { return 16 + (66 * p[0] + 129 * p[1] + 25 * p[2] + 128) / 256; }

void pair_to_yuyv(const std::uint8_t* p, std::uint8_t* out) {
  const int r = p[0] + p[3];
  const int g = p[1] + p[4];
  const int b = p[2] + p[5];
  out[0] = byte(luma(p));
  out[1] = byte((128 * 512 - 38 * r - 74 * g + 112 * b + 256) / 512);
  out[2] = byte(luma(p + 3));
  out[3] = byte((128 * 512 + 112 * r - 94 * g - 18 * b + 256) / 512);
}

}  // namespace

void convert_rgb24(const std::vector<std::uint8_t>& rgb, int width, int height, PixelFormat to,
                   std::vector<std::uint8_t>& out) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  out.resize(pixels * static_cast<std::size_t>(bytes_per_pixel(to)));
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint8_t* p = &rgb[i * 3U];
    if (to == PixelFormat::rgb24) std::copy_n(p, 3, &out[i * 3U]);
    if (to == PixelFormat::bgr24) std::reverse_copy(p, p + 3, &out[i * 3U]);
    if (to == PixelFormat::rgb565) {
      const int word = (p[0] >> 3) << 11 | (p[1] >> 2) << 5 | p[2] >> 3;
      out[i * 2U] = byte(word & 255);
      out[i * 2U + 1U] = byte(word >> 8);
    }
    if (to == PixelFormat::yuyv && i % 2U == 0U) pair_to_yuyv(p, &out[i * 2U]);
  }
}

}  // namespace touchline::sim
