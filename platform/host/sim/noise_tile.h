// SPDX-License-Identifier: Apache-2.0
// Tileable noise looked up by position: the grain of carpet, floor and walls, and the sensor's noise.
#pragma once

#include <array>
#include <cstdint>

#include "platform/core/rng.h"

namespace touchline::sim {

/// 256 x 256 texels that repeat seamlessly, mean 0, about 40 units standard deviation in an int8.
class NoiseTile {
 public:
  static constexpr int size = 256;
  static constexpr float unit = 40.0F;  // texel value of one standard deviation

  /// Value noise summed over `octaves`, the coarsest with cells of `cell` texels (a power of two), each further one
  /// half the size and `persistence` times the strength.
  void generate(Rng& rng, int cell, int octaves, float persistence);
  /// In standard deviations; bilinear; positions in texels, above -8192.
  [[nodiscard]] float sample(float x, float y) const {
    const float px = x + 8192.0F;
    const float py = y + 8192.0F;
    const int ix = static_cast<int>(px);
    const int iy = static_cast<int>(py);
    const float fx = px - static_cast<float>(ix);
    const float fy = py - static_cast<float>(iy);
    const std::int8_t* row0 = row(iy);
    const std::int8_t* row1 = row(iy + 1);
    const int x0 = ix & (size - 1);
    const int x1 = (ix + 1) & (size - 1);
    const float top = static_cast<float>(row0[x0]) * (1.0F - fx) + static_cast<float>(row0[x1]) * fx;
    const float bottom = static_cast<float>(row1[x0]) * (1.0F - fx) + static_cast<float>(row1[x1]) * fx;
    return (top + (bottom - top) * fy) * (1.0F / unit);
  }
  /// In standard deviations, the nearest texel; for where a pixel is no smaller than a texel.
  [[nodiscard]] float nearest(float x, float y) const {
    return static_cast<float>(texels_[index(static_cast<int>(x + 8192.0F), static_cast<int>(y + 8192.0F))]) *
           (1.0F / unit);
  }
  /// The 256 texels of a row that repeats.
  [[nodiscard]] const std::int8_t* row(int y) const { return &texels_[index(0, y)]; }
  [[nodiscard]] std::int8_t texel(int x, int y) const { return texels_[index(x, y)]; }

 private:
  static std::size_t index(int x, int y) {
    return static_cast<std::size_t>(y & (size - 1)) * size + static_cast<std::size_t>(x & (size - 1));
  }
  std::array<std::int8_t, static_cast<std::size_t>(size) * size> texels_{};
};

}  // namespace touchline::sim
