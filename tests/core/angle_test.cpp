// SPDX-License-Identifier: Apache-2.0
#include "platform/core/angle.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "platform/core/rng.h"

using touchline::wrap_angle;
namespace math = touchline::math;

TEST_CASE("an angle already in (-pi, pi] is returned bit for bit") {
  for (const float angle : {0.0F, 1.0F, -3.14F, 3.14159F, math::pi}) CHECK(wrap_angle(angle) == angle);
  CHECK(wrap_angle(-math::pi) == math::pi);
}

TEST_CASE("wrapping keeps the direction and lands in the range") {
  touchline::Rng rng(1);
  for (const float range : {10.0F, 1.0e3F, 1.0e6F}) {
    for (int i = 0; i < 2000; ++i) {
      const float angle = rng.uniform(-range, range);
      const float wrapped = wrap_angle(angle);
      CHECK_UNARY(wrapped > -math::pi);
      CHECK_UNARY(wrapped <= math::pi);
      const double turned = static_cast<double>(angle) - static_cast<double>(wrapped);
      CHECK_UNARY(std::abs(std::remainder(turned, 6.283185307179586)) < 3e-7);
    }
  }
}

TEST_CASE("no angle is too large, and NaN stays NaN") {
  CHECK(wrap_angle(3.0e38F) == 0.0F);
  CHECK(wrap_angle(std::numeric_limits<float>::infinity()) == 0.0F);
  CHECK(std::isnan(wrap_angle(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("the difference of two angles goes the short way") {
  const float difference = touchline::angle_difference(touchline::radians(-170.0F), touchline::radians(170.0F));
  CHECK(touchline::degrees(difference) == doctest::Approx(20.0).epsilon(1e-5));
}
