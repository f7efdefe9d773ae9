// SPDX-License-Identifier: Apache-2.0
// From light on the sensor to an 8-bit picture: blur of the optics, gamma, noise.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/host/sim/noise_tile.h"

namespace touchline::sim {

struct ImageEffects {
  float blur_px = 0.6F;      // standard deviation of the optics' blur, pixels, 0..1.2
  float noise = 3.0F;        // standard deviation of the sensor's noise, of 255
  float vignetting = 0.35F;  // share of the light lost at the rim
  bool supersample_edges = true;
};

/// Linear light of the last rows of a frame, one plane a channel. A ring, since the whole would not stay in the cache.
class LightRows {
 public:
  static constexpr int kept = 8;
  void resize(int width, int height);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  /// `y` is one of the last `kept` rows that were written.
  [[nodiscard]] float* row(int channel, int y) { return &values_[offset(channel, y)]; }
  [[nodiscard]] const float* row(int channel, int y) const { return &values_[offset(channel, y)]; }

 private:
  [[nodiscard]] std::size_t offset(int channel, int y) const {
    return static_cast<std::size_t>((y % kept) * 3 + channel) * static_cast<std::size_t>(width_);
  }
  int width_ = 0;
  int height_ = 0;
  std::vector<float> values_;
};

class Developer {
 public:
  Developer();
  static constexpr int rows_below = 2;  // that the blur of a row needs
  /// Starts a frame.
  void begin(const LightRows& light, const ImageEffects& effects, std::uint64_t noise_seed);
  /// One row as RGB24; needs rows y - 2 to y + 2 of the light.
  void develop(const LightRows& light, int y, std::uint8_t* rgb);

 private:
  void develop_row(const LightRows& light, int channel, int y, std::uint8_t* out);

  NoiseTile noise_;
  std::array<float, 3> kernel_{};  // of the blur: middle, next, next but one
  float noise_scale_ = 0.0F;
  std::array<int, 3> shift_x_{}, shift_y_{};  // of the noise, for each channel
  std::vector<float> vertical_, both_;        // rows, with a margin
  std::vector<float> grain_;
  std::vector<std::uint8_t> row_;  // three planes
};

}  // namespace touchline::sim
