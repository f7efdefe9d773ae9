// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/develop.h"

#include <algorithm>
#include <cmath>

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
void blur_rows(const LightRows& light, int channel, int y, const std::array<float, 3>& k, float* out) {
  const int width = light.width();
  const auto row = [&](int r) { return light.row(channel, std::clamp(r, 0, light.height() - 1)); };
  const float* a = row(y - 2);
  const float* b = row(y - 1);
  const float* c = row(y);
  const float* d = row(y + 1);
  const float* e = row(y + 2);
  float* to = out + margin;
  for (int x = 0; x < width; ++x) to[x] = k[0] * c[x] + k[1] * (b[x] + d[x]) + k[2] * (a[x] + e[x]);
  out[0] = out[1] = to[0];
  to[width] = to[width + 1] = to[width - 1];
}

}  // namespace

void LightRows::resize(int width, int height) {
  width_ = width;
  height_ = height;
  values_.assign(static_cast<std::size_t>(width) * 3U * kept, 0.0F);
}

Developer::Developer() {
  Rng rng(20, 15);
  noise_.generate(rng, 2, 2, 1.3F);  // demosaicing makes a sensor's noise a little smooth
}

void Developer::develop_row(const LightRows& light, int channel, int y, std::uint8_t* out) {
  const auto c = static_cast<std::size_t>(channel);
  const int width = light.width();
  blur_rows(light, channel, y, kernel_, vertical_.data());
  const float* v = vertical_.data() + margin;
  float* both = both_.data();
  const auto [middle, next, far] = kernel_;
  for (int x = 0; x < width; ++x) {
    both[x] = middle * v[x] + next * (v[x - 1] + v[x + 1]) + far * (v[x - 2] + v[x + 2]);
  }
  const int across = shift_x_[c] + y / NoiseTile::size * 37;  // the tile repeats downwards, shifted
  float* grain = grain_.data();
  const std::int8_t* texels = noise_.row(y + shift_y_[c]);
  for (int x = 0; x < width;) {  // runs up to the tile's edge
    const int from = (x + across) % NoiseTile::size;
    const int run = std::min(NoiseTile::size - from, width - x);
    for (int i = 0; i < run; ++i) grain[x + i] = static_cast<float>(texels[from + i]);
    x += run;
  }
  const float scale = noise_scale_;
  for (int x = 0; x < width; ++x) {
    const float shown = 255.0F * std::sqrt(std::min(both[x], 1.0F)) + grain[x] * scale + 0.5F;
    out[x] = static_cast<std::uint8_t>(static_cast<int>(std::min(std::max(shown, 0.0F), 255.0F)));
  }
}

void Developer::begin(const LightRows& light, const ImageEffects& effects, std::uint64_t noise_seed) {
  kernel_ = kernel(math::clamp(effects.blur_px, 0.0F, 1.2F));
  noise_scale_ = effects.noise / NoiseTile::unit;
  Rng rng(noise_seed, 6);
  for (std::size_t c = 0; c < 3; ++c) {
    shift_x_[c] = static_cast<int>(rng.below(NoiseTile::size));
    shift_y_[c] = static_cast<int>(rng.below(NoiseTile::size));
  }
  const auto width = static_cast<std::size_t>(light.width());
  vertical_.resize(width + 2U * margin);
  both_.resize(width);
  grain_.resize(width);
  row_.resize(width * 3U);
}

void Developer::develop(const LightRows& light, int y, std::uint8_t* rgb) {
  const auto width = static_cast<std::size_t>(light.width());
  for (int c = 0; c < 3; ++c) develop_row(light, c, y, &row_[static_cast<std::size_t>(c) * width]);
  for (std::size_t x = 0; x < width; ++x) {
    rgb[3U * x] = row_[x];
    rgb[3U * x + 1U] = row_[width + x];
    rgb[3U * x + 2U] = row_[2U * width + x];
  }
}

}  // namespace touchline::sim
