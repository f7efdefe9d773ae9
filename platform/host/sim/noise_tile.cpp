// SPDX-License-Identifier: Apache-2.0
// Value noise: random lattices, interpolated smoothly, summed over octaves and scaled to a fixed standard deviation.
#include "platform/host/sim/noise_tile.h"

#include <vector>

#include "platform/core/elementary.h"

namespace touchline::sim {
namespace {

float smooth(float t) { return t * t * (3.0F - 2.0F * t); }

void add_octave(Rng& rng, int cell, float strength, std::vector<float>& sum) {
  const int lattice = NoiseTile::size / cell;
  std::vector<float> value(static_cast<std::size_t>(lattice * lattice));
  for (float& v : value) v = rng.gaussian() * strength;
  const auto at = [&](int x, int y) { return value[static_cast<std::size_t>((y % lattice) * lattice + x % lattice)]; };
  for (int y = 0; y < NoiseTile::size; ++y) {
    const float fy = smooth(static_cast<float>(y % cell) / static_cast<float>(cell));
    for (int x = 0; x < NoiseTile::size; ++x) {
      const float fx = smooth(static_cast<float>(x % cell) / static_cast<float>(cell));
      const int i = x / cell;
      const int j = y / cell;
      const float top = at(i, j) * (1.0F - fx) + at(i + 1, j) * fx;
      const float bottom = at(i, j + 1) * (1.0F - fx) + at(i + 1, j + 1) * fx;
      sum[static_cast<std::size_t>(y * NoiseTile::size + x)] += top * (1.0F - fy) + bottom * fy;
    }
  }
}

}  // namespace

void NoiseTile::generate(Rng& rng, int cell, int octaves, float persistence) {
  std::vector<float> sum(texels_.size(), 0.0F);
  float strength = 1.0F;
  for (int octave = 0; octave < octaves && cell >= 1; ++octave) {
    add_octave(rng, cell, strength, sum);
    cell /= 2;
    strength *= persistence;
  }
  float mean = 0.0F;
  for (const float v : sum) mean += v;
  mean /= static_cast<float>(sum.size());
  float variance = 0.0F;
  for (const float v : sum) variance += (v - mean) * (v - mean);
  const float scale = unit / math::sqrt(variance / static_cast<float>(sum.size()) + 1e-12F);
  for (std::size_t i = 0; i < sum.size(); ++i) {
    texels_[i] = static_cast<std::int8_t>(math::clamp((sum[i] - mean) * scale, -127.0F, 127.0F));
  }
}

}  // namespace touchline::sim
