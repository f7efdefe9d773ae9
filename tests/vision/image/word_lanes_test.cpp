// SPDX-License-Identifier: Apache-2.0
// Arithmetic on the bytes of a word against the same on each byte.
#include "vision/image/word_lanes.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <random>

using namespace touchline;

namespace {

using Bytes = std::array<std::uint8_t, 4>;

Bytes bytes_of(std::uint32_t word) { return std::bit_cast<Bytes>(word); }

}  // namespace

TEST_CASE("bytes of a word are subtracted, compared and added as bytes") {
  std::mt19937 random(5);
  for (int round = 0; round < 20000; ++round) {
    const auto a = static_cast<std::uint32_t>(random());
    // Equal bytes and neighbours are as likely as any others.
    const auto b =
        round % 3 == 0 ? static_cast<std::uint32_t>(random()) : a ^ static_cast<std::uint32_t>(random() & 0x81018001U);
    const Bytes x = bytes_of(a), y = bytes_of(b);
    const Bytes difference = bytes_of(excess(a, b)), portable = bytes_of(portable_excess(a, b));
    const Bytes smaller = bytes_of(smaller_bytes(a, b)), larger = bytes_of(larger_bytes(a, b));
    for (std::size_t i = 0; i < 4; ++i) {
      const int expected = std::max(x[i] - y[i], 0);
      REQUIRE(difference[i] == expected);
      REQUIRE(portable[i] == expected);
      REQUIRE(smaller[i] == std::min(x[i], y[i]));
      REQUIRE(larger[i] == std::max(x[i], y[i]));
    }
    REQUIRE(smallest_byte(a) == *std::min_element(x.begin(), x.end()));
    REQUIRE(largest_byte(a) == *std::max_element(x.begin(), x.end()));
    REQUIRE(even_bytes(a) == (x[0] | std::uint32_t{x[2]} << 16U));
    REQUIRE(odd_bytes(a) == (x[1] | std::uint32_t{x[3]} << 16U));
    REQUIRE(add_even_bytes(0x01000FF0U, a) == 0x01000FF0U + even_bytes(a));
    REQUIRE(add_odd_bytes(0x01000FF0U, a) == 0x01000FF0U + odd_bytes(a));
  }
}

TEST_CASE("halves of a word are compared and freed of their sign as halves") {
  std::mt19937 random(6);
  for (int round = 0; round < 20000; ++round) {
    const auto half = [&] { return static_cast<std::uint32_t>(random() % (round % 2 == 0 ? 0x8000U : 5U)); };
    const std::uint32_t a0 = half(), a1 = half(), b0 = half(), b1 = half();
    const std::uint32_t a = a0 | a1 << 16U, b = b0 | b1 << 16U;
    REQUIRE(smaller_halves(a, b) == (std::min(a0, b0) | std::min(a1, b1) << 16U));
    REQUIRE(portable_smaller_halves(a, b) == smaller_halves(a, b));
    const auto biased = [&] { return static_cast<std::uint32_t>(random() % 0x7FFFU) + 1U; };
    const auto plain = [](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::abs(static_cast<int>(v) - half_bias));
    };
    const std::uint32_t c0 = biased(), c1 = biased(), c = c0 | c1 << 16U;
    REQUIRE(without_bias_and_sign(c) == (plain(c0) | plain(c1) << 16U));
    REQUIRE(portable_without_bias_and_sign(c) == without_bias_and_sign(c));
  }
}
