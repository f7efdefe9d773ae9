// SPDX-License-Identifier: Apache-2.0
// The stated error bounds against the C library in double precision, and a fingerprint of all results: the last bit is
// the same on every compiler.
#include "platform/core/elementary.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>

#include "platform/core/hash.h"
#include "platform/core/rng.h"

namespace math = touchline::math;

namespace {

constexpr int samples = 200000;
const float not_a_number = std::numeric_limits<float>::quiet_NaN();
const float infinity = std::numeric_limits<float>::infinity();

template <typename F, typename G>
double worst_absolute(float low, float high, F ours, G exact) {
  touchline::Rng rng(7);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float x = rng.uniform(low, high);
    worst = std::max(worst, std::abs(static_cast<double>(ours(x)) - exact(static_cast<double>(x))));
  }
  return worst;
}

}  // namespace

TEST_CASE("sine and cosine keep their bound up to 10,000 radians") {
  const auto sine = [](double x) { return std::sin(x); };
  const auto cosine = [](double x) { return std::cos(x); };
  for (const float range : {4.0F, 100.0F, 1.0e4F}) {
    CHECK(worst_absolute(-range, range, math::sin, sine) < 2e-7);
    CHECK(worst_absolute(-range, range, math::cos, cosine) < 2e-7);
  }
  CHECK(math::sin(0.0F) == 0.0F);
  CHECK(math::cos(0.0F) == 1.0F);
  CHECK(std::isnan(math::sin(not_a_number)));
  CHECK(std::abs(math::sin(3.0e38F)) <= 1.0F);
  CHECK(std::abs(math::cos(infinity)) <= 1.0F);
}

TEST_CASE("tangent keeps its relative bound") {
  touchline::Rng rng(8);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float x = rng.uniform(-10.0F, 10.0F);
    const double exact = std::tan(static_cast<double>(x));
    if (std::abs(exact) > 999.0 || std::abs(exact) < 1.001e-3) continue;
    worst = std::max(worst, std::abs(static_cast<double>(math::tan(x)) / exact - 1.0));
  }
  // The reduced angle itself is rounded to 6e-8: near a pole or zero of the tangent that is its relative error.
  CHECK(worst < 1e-6);
}

TEST_CASE("inverse functions keep their bounds") {
  CHECK(worst_absolute(-2.0F, 2.0F, math::atan, [](double x) { return std::atan(x); }) < 3e-7);
  CHECK(worst_absolute(-1e3F, 1e3F, math::atan, [](double x) { return std::atan(x); }) < 3e-7);
  CHECK(worst_absolute(-1.0F, 1.0F, math::asin, [](double x) { return std::asin(x); }) < 4e-7);
  CHECK(worst_absolute(-1.0F, 1.0F, math::acos, [](double x) { return std::acos(x); }) < 4e-7);
  CHECK(worst_absolute(0.9999F, 1.0F, math::acos, [](double x) { return std::acos(x); }) < 4e-7);
  CHECK(math::asin(1.5F) == math::half_pi);
  CHECK(math::acos(-1.5F) == math::pi);
  CHECK(math::atan(infinity) == math::half_pi);
  CHECK(math::atan(-infinity) == -math::half_pi);
  CHECK(std::isnan(math::atan(not_a_number)));
}

TEST_CASE("atan2 covers the circle and stays in (-pi, pi]") {
  touchline::Rng rng(9);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float y = rng.uniform(-3.0F, 3.0F);
    const float x = rng.uniform(-3.0F, 3.0F);
    const double exact = std::atan2(static_cast<double>(y), static_cast<double>(x));
    worst = std::max(worst, std::abs(static_cast<double>(math::atan2(y, x)) - exact));
  }
  CHECK(worst < 3e-7);
  CHECK(math::atan2(0.0F, 0.0F) == 0.0F);
  CHECK(math::atan2(0.0F, -1.0F) == math::pi);
  CHECK(math::atan2(-0.0F, -1.0F) == math::pi);
  CHECK(math::atan2(-1.0e-30F, -1.0F) == math::pi);
  CHECK(math::atan2(1.0F, 0.0F) == math::half_pi);
  CHECK(math::atan2(-1.0F, 0.0F) == -math::half_pi);
  CHECK(math::atan2(0.0F, 1.0F) == 0.0F);
  CHECK(std::isnan(math::atan2(not_a_number, 1.0F)));
  CHECK(std::isnan(math::atan2(1.0F, not_a_number)));
}

TEST_CASE("exponential keeps its relative bound and saturates") {
  touchline::Rng rng(10);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float x = rng.uniform(-87.0F, 88.0F);
    worst = std::max(worst, std::abs(static_cast<double>(math::exp(x)) / std::exp(static_cast<double>(x)) - 1.0));
  }
  CHECK(worst < 3e-7);
  CHECK(math::exp(0.0F) == 1.0F);
  CHECK(math::exp(-88.0F) == 0.0F);
  CHECK(math::exp(-infinity) == 0.0F);
  CHECK(math::exp(89.0F) == 3.4e38F);
  CHECK(std::isnan(math::exp(not_a_number)));
}

TEST_CASE("logarithm keeps its bound") {
  touchline::Rng rng(11);
  double worst = 0.0;
  for (int i = 0; i < samples; ++i) {
    const float x = math::exp(rng.uniform(-87.0F, 88.0F));
    const double exact = std::log(static_cast<double>(x));
    const double bound = 2e-7 + 1e-7 * std::abs(exact);
    worst = std::max(worst, std::abs(static_cast<double>(math::log(x)) - exact) / bound);
  }
  CHECK(worst < 1.0);
  CHECK(math::log(1.0F) == 0.0F);
  CHECK(math::log(0.0F) == math::log(-3.0F));
  CHECK(static_cast<double>(math::log(0.0F)) ==
        doctest::Approx(std::log(static_cast<double>(std::numeric_limits<float>::min()))).epsilon(1e-6));
  CHECK(std::isnan(math::log(not_a_number)));
}

TEST_CASE("square root is correctly rounded, and zero below zero") {
  touchline::Rng rng(12);
  int different = 0;
  for (int i = 0; i < samples; ++i) {
    const float x = math::exp(rng.uniform(-80.0F, 80.0F));
    if (math::sqrt(x) != static_cast<float>(std::sqrt(static_cast<double>(x)))) ++different;
  }
  CHECK(different == 0);
  CHECK(math::sqrt(-1.0F) == 0.0F);
  CHECK(math::hypot(3.0F, 4.0F) == 5.0F);
}

TEST_CASE("not finite is recognised") {
  CHECK(math::is_finite(3.4e38F));
  CHECK_FALSE(math::is_finite(not_a_number));
  CHECK_FALSE(math::is_finite(infinity));
  CHECK_FALSE(math::is_finite(-infinity));
}

TEST_CASE("every bit of the results is the same everywhere") {
  touchline::Rng rng(13);
  std::uint64_t hash = touchline::hash_seed;
  for (int i = 0; i < 20000; ++i) {
    const float x = rng.uniform(-20.0F, 20.0F);
    const float y = rng.uniform(-20.0F, 20.0F);
    const float results[] = {math::sin(x),      math::cos(x),          math::tan(x),          math::atan(x),
                             math::atan2(y, x), math::asin(x * 0.05F), math::acos(y * 0.05F), math::exp(x),
                             math::log(x),      math::sqrt(y),         math::hypot(x, y),     rng.gaussian()};
    hash = touchline::hash_bytes(results, sizeof(results), hash);
  }
  CHECK(hash == 15144602882614261143ULL);
}
