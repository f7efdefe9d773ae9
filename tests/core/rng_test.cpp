// SPDX-License-Identifier: Apache-2.0
#include "platform/core/rng.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>

using touchline::Rng;

TEST_CASE("the first numbers are those of the published generator") {
  // Published output of PCG32 with seed 42 and stream 54.
  Rng rng(42, 54);
  const std::array<std::uint32_t, 6> expected{0xa15c02b7, 0x7b47f409, 0xba1d3330, 0x83d2f293, 0xbfa4784b, 0xcbed606e};
  for (const std::uint32_t value : expected) CHECK(rng.next_u32() == value);
}

TEST_CASE("another seed or another stream is another sequence") {
  CHECK(Rng(1).next_u32() != Rng(2).next_u32());
  CHECK(Rng(1, 1).next_u32() != Rng(1, 2).next_u32());
}

TEST_CASE("uniform numbers stay in their range and fill it evenly") {
  Rng rng(5);
  double sum = 0.0;
  std::array<int, 10> bins{};
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const float u = rng.uniform();
    REQUIRE(u >= 0.0F);
    REQUIRE(u < 1.0F);
    sum += static_cast<double>(u);
    ++bins[static_cast<std::size_t>(u * 10.0F)];
  }
  CHECK(sum / n == doctest::Approx(0.5).epsilon(0.01));
  for (const int count : bins) CHECK(std::abs(count - n / 10) < 500);  // 5 sigma
}

TEST_CASE("below() is even, also for a bound that divides nothing") {
  Rng rng(6);
  std::array<int, 7> bins{};
  for (int i = 0; i < 70000; ++i) ++bins[rng.below(7)];
  for (const int count : bins) CHECK(std::abs(count - 10000) < 470);  // 5 sigma
  CHECK(rng.below(1) == 0);
}

TEST_CASE("normal numbers have mean 0, deviation 1 and the tails of the bell") {
  Rng rng(7);
  constexpr int n = 200000;
  double sum = 0.0;
  double squares = 0.0;
  int beyond_two = 0;
  for (int i = 0; i < n; ++i) {
    const double g = static_cast<double>(rng.gaussian());
    sum += g;
    squares += g * g;
    if (std::abs(g) > 2.0) ++beyond_two;
  }
  CHECK(std::abs(sum / n) < 0.012);
  CHECK(squares / n == doctest::Approx(1.0).epsilon(0.016));
  CHECK(static_cast<double>(beyond_two) / n == doctest::Approx(0.0455).epsilon(0.06));
}
