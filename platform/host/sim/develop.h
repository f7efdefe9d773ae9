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

/// Linear light of a frame, one plane a channel.
struct LightPlanes {
  int width = 0;
  int height = 0;
  std::array<std::vector<float>, 3> plane;
  void resize(int w, int h);
};

class Developer {
 public:
  explicit Developer();
  /// `rgb` becomes width * height * 3 bytes.
  void develop(const LightPlanes& light, const ImageEffects& effects, std::uint64_t noise_seed,
               std::vector<std::uint8_t>& rgb);

 private:
  static constexpr int table_size = 8192;               // index of linear light 1
  std::array<std::int16_t, table_size + 1> gamma_{};    // in 1/16 of an 8-bit step
  NoiseTile noise_;
  std::vector<float> blurred_;
};

}  // namespace touchline::sim
