// SPDX-License-Identifier: Apache-2.0
// Range reduction after Cody and Waite ("Software Manual for the Elementary Functions", 1980), then polynomials. Their
// coefficients are our own minimax fits (iteratively reweighted least squares in double); the error of each fit alone
// is given beside it.
#include "platform/core/elementary.h"

#include <bit>
#include <cstdint>

#include "platform/core/angle.h"
#include "platform/core/atan2_lanes.h"

namespace touchline::math {
namespace {

// pi/2 in three parts: the first two have 11 bits each, so that their products with a 13-bit integer are exact.
constexpr float half_pi_high = 1.5703125F;
constexpr float half_pi_middle = 4.837512969970703e-4F;
constexpr float half_pi_low = 7.549789954891882e-8F;
constexpr float two_over_pi = 0.636619772367581F;
constexpr float max_direct_angle = 1.0e4F;  // 6366 quarter turns: 13 bits

// On [-pi/4, pi/4]; relative error of the fit 4e-9.
float sin_polynomial(float x) {
  const float z = x * x;
  return x + x * z * (-0.166666549437F + z * (8.332178147e-3F + z * -1.9517299e-4F));
}

// On [-pi/4, pi/4]; absolute error of the fit 1e-10.
float cos_polynomial(float x) {
  const float z = x * x;
  const float tail = z * z * (4.166664686642e-2F + z * (-1.388736751474e-3F + z * 2.443845149276e-5F));
  return 1.0F - (0.5F * z - tail);
}

std::int32_t nearest_integer(float x) { return static_cast<std::int32_t>(x < 0.0F ? x - 0.5F : x + 0.5F); }

}  // namespace

SinCos sin_cos(float radians) {
  if (radians != radians) return {radians, radians};
  if (!(abs(radians) <= max_direct_angle)) radians = wrap_angle(radians);
  const std::int32_t quadrant = nearest_integer(radians * two_over_pi);
  const float n = static_cast<float>(quadrant);
  const float r = ((radians - n * half_pi_high) - n * half_pi_middle) - n * half_pi_low;
  const float s = sin_polynomial(r);
  const float c = cos_polynomial(r);
  switch (static_cast<std::uint32_t>(quadrant) & 3U) {
    case 0: return {s, c};
    case 1: return {c, -s};
    case 2: return {-s, -c};
    default: return {-c, s};
  }
}

float sin(float radians) { return sin_cos(radians).sin; }

float cos(float radians) { return sin_cos(radians).cos; }

float tan(float radians) {
  const SinCos both = sin_cos(radians);
  return both.sin / both.cos;
}

float atan2(float y, float x) {
  return atan2_by(y, x, [](bool condition, float a, float b) { return condition ? a : b; });
}

float atan(float x) {
  if (abs(x) > 3.0e38F) return x < 0.0F ? -half_pi : half_pi;
  return atan2(x, 1.0F);
}

float asin(float x) {
  const float y = clamp(x, -1.0F, 1.0F);
  return atan2(y, sqrt((1.0F - y) * (1.0F + y)));
}

float acos(float x) {
  const float y = clamp(x, -1.0F, 1.0F);
  return atan2(sqrt((1.0F - y) * (1.0F + y)), y);
}

float exp(float x) {
  if (x != x) return x;
  if (x < -87.0F) return 0.0F;
  if (x > 88.0F) return 3.4e38F;
  // ln 2 in two parts: the first has 15 bits, so that its product with a 8-bit integer is exact.
  constexpr float ln2_high = 0.693145751953125F;
  constexpr float ln2_low = 1.4286068203094173e-6F;
  const std::int32_t n = nearest_integer(x * 1.44269504088896F);
  const float r = (x - static_cast<float>(n) * ln2_high) - static_cast<float>(n) * ln2_low;
  // On [-ln2/2, ln2/2]; error of the fit 3e-9.
  const float p =
      r * r *
      (0.500000009513F + r * (0.166665188987F + r * (4.1666205988e-2F + r * (8.368882249e-3F + r * 1.395047869e-3F))));
  // n is in [-126, 127]: a normal power of two.
  const float scale = std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23U);
  return (1.0F + (r + p)) * scale;
}

float log(float x) {
  if (x != x) return x;
  if (x < 1.17549435e-38F) return -87.336545F;
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x);
  std::int32_t exponent = static_cast<std::int32_t>(bits >> 23U) - 127;
  float mantissa = std::bit_cast<float>((bits & 0x007FFFFFU) | 0x3F800000U);  // [1, 2)
  if (mantissa > 1.41421356F) {
    mantissa *= 0.5F;
    ++exponent;
  }
  // log m = 2 atanh((m - 1) / (m + 1)); relative error of the fit 2e-9.
  const float s = (mantissa - 1.0F) / (mantissa + 1.0F);
  const float z = s * s;
  const float p = s * z * (0.666667763815F + z * (0.399775415883F + z * 0.298717274544F));
  const float n = static_cast<float>(exponent);
  return n * 0.693145751953125F + (2.0F * s + (p + n * 1.4286068203094173e-6F));
}

}  // namespace touchline::math
