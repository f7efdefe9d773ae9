// SPDX-License-Identifier: Apache-2.0
// Noise has the strength it claims, repeats without a seam, and follows its seed.
#include "platform/host/sim/noise_tile.h"

#include <doctest/doctest.h>

#include <cmath>
#include <memory>

using touchline::Rng;
using touchline::sim::NoiseTile;

namespace {

std::unique_ptr<NoiseTile> tile(std::uint64_t seed) {
  auto t = std::make_unique<NoiseTile>();
  Rng rng(seed);
  t->generate(rng, 16, 4, 0.7F);
  return t;
}

}  // namespace

TEST_CASE("noise: mean 0 and standard deviation 1") {
  const auto t = tile(3);
  double sum = 0.0;
  double squares = 0.0;
  for (int y = 0; y < NoiseTile::size; ++y) {
    for (int x = 0; x < NoiseTile::size; ++x) {
      const double v = static_cast<double>(t->nearest(static_cast<float>(x), static_cast<float>(y)));
      sum += v;
      squares += v * v;
    }
  }
  const double n = 256.0 * 256.0;
  CHECK(std::abs(sum / n) < 0.02);
  CHECK(std::sqrt(squares / n) == doctest::Approx(1.0).epsilon(0.03));
}

TEST_CASE("noise: repeats every 256 texels without a seam") {
  const auto t = tile(4);
  double inside = 0.0;
  double across = 0.0;
  for (int y = 0; y < NoiseTile::size; ++y) {
    CHECK(t->texel(-1, y) == t->texel(255, y));
    inside += std::abs(t->texel(100, y) - t->texel(101, y));
    across += std::abs(t->texel(255, y) - t->texel(256, y));
  }
  CHECK(across < 2.0 * inside);
}

TEST_CASE("noise: interpolates between its texels, and follows the seed") {
  const auto a = tile(5);
  const auto b = tile(5);
  const auto c = tile(6);
  CHECK(a->sample(10.0F, 20.0F) == doctest::Approx(a->nearest(10.0F, 20.0F)));
  const float middle = 0.5F * (a->nearest(10.0F, 20.0F) + a->nearest(11.0F, 20.0F));
  CHECK(a->sample(10.5F, 20.0F) == doctest::Approx(middle));
  CHECK(a->texel(7, 9) == b->texel(7, 9));
  int different = 0;
  for (int x = 0; x < 256; ++x) different += a->texel(x, 9) != c->texel(x, 9) ? 1 : 0;
  CHECK(different > 200);
}
