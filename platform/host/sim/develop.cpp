// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/develop.h"

#include <algorithm>

#include "platform/host/sim/vec.h"

namespace touchline::sim {
namespace {

constexpr int margin = 2;  // taps on each side

std::array<float, 3> kernel(float sigma) {
  if (sigma < 0.05F) return {1.0F, 0.0F, 0.0F};
  const float one = math::exp(-0.5F / (sigma * sigma));
  const float two = math::exp(-2.0F / (sigma * sigma));
  const float sum = 1.0F + 2.0F * one + 2.0F * two;
  return {1.0F / sum, one / sum, two / sum};
}

/// Columns of one row, blurred over rows, with the ends repeated by `margin`.
void blur_rows(const LightPlanes& light, int channel, int y, const std::array<float, 3>& k, float* out) {
  const auto& plane = light.plane[static_cast<std::size_t>(channel)];
  const auto row = [&](int r) {
    return &plane[static_cast<std::size_t>(std::clamp(r, 0, light.height - 1)) * static_cast<std::size_t>(light.width)];
  };
  const float* a = row(y - 2);
  const float* b = row(y - 1);
  const float* c = row(y);
  const float* d = row(y + 1);
  const float* e = row(y + 2);
  float* to = out + margin;
  for (int x = 0; x < light.width; ++x) to[x] = k[0] * c[x] + k[1] * (b[x] + d[x]) + k[2] * (a[x] + e[x]);
  out[0] = out[1] = to[0];
  to[light.width] = to[light.width + 1] = to[light.width - 1];
}

}  // namespace

void LightPlanes::resize(int w, int h) {
  width = w;
  height = h;
  for (auto& p : plane) p.resize(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
}

Developer::Developer() {
  for (int i = 0; i <= table_size; ++i) {
    const float linear = static_cast<float>(i) / table_size;
    const float shown = i == 0 ? 0.0F : math::exp(math::log(linear) / display_gamma);
    gamma_[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(shown * 255.0F * 16.0F + 0.5F);
  }
  Rng rng(20, 15);
  noise_.generate(rng, 2, 2, 1.3F);  // demosaicing makes a sensor's noise a little smooth
}

void Developer::develop(const LightPlanes& light, const ImageEffects& effects, std::uint64_t noise_seed,
                        std::vector<std::uint8_t>& rgb) {
  const auto k = kernel(math::clamp(effects.blur_px, 0.0F, 1.2F));
  const auto width = static_cast<std::size_t>(light.width);
  rgb.resize(width * static_cast<std::size_t>(light.height) * 3U);
  blurred_.resize((width + 2U * margin) * 2U);
  float* vertical = blurred_.data();
  float* both = vertical + width + 2U * margin;
  Rng rng(noise_seed, 6);
  const int strength = static_cast<int>(effects.noise / NoiseTile::unit * 16.0F * 64.0F + 0.5F);
  for (int channel = 0; channel < 3; ++channel) {
    const int shift_x = static_cast<int>(rng.below(NoiseTile::size));
    const int shift_y = static_cast<int>(rng.below(NoiseTile::size));
    for (int y = 0; y < light.height; ++y) {
      blur_rows(light, channel, y, k, vertical);
      const float* v = vertical + margin;
      for (int x = 0; x < light.width; ++x) {
        both[x] = (k[0] * v[x] + k[1] * (v[x - 1] + v[x + 1]) + k[2] * (v[x - 2] + v[x + 2])) * table_size;
      }
      std::uint8_t* out = &rgb[static_cast<std::size_t>(y) * width * 3U + static_cast<std::size_t>(channel)];
      const int wrap = y / NoiseTile::size * 37;  // the tile repeats downwards, shifted
      for (int x = 0; x < light.width; ++x) {
        const int index = std::min(static_cast<int>(both[x]), table_size);
        const int grain = noise_.texel(x + shift_x + wrap, y + shift_y) * strength;
        const int value = (gamma_[static_cast<std::size_t>(index)] * 64 + grain + 8 * 64) >> 10;
        out[3 * x] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
      }
    }
  }
}

}  // namespace touchline::sim
