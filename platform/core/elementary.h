// SPDX-License-Identifier: Apache-2.0
// Elementary functions of our own, so that a pose is the same bit for bit on every compiler, C library and board.
// They use only +, -, *, / and sqrt, which IEEE 754 rounds correctly everywhere (built with -ffp-contract=off).
// Error bounds are stated per function and checked by tests against double precision. NaN in, NaN out; no function has
// undefined behaviour for any input.
#pragma once

namespace touchline::math {

inline constexpr float pi = 3.14159265358979323846F;
inline constexpr float two_pi = 6.28318530717958647692F;
inline constexpr float half_pi = 1.57079632679489661923F;

/// Correctly rounded; x < 0 gives 0. One instruction (built with -fno-math-errno, so that no call for errno is left).
inline float sqrt(float x) { return x < 0.0F ? 0.0F : __builtin_sqrtf(x); }

float sin(float radians);       // |radians| <= 1e4: absolute error < 2e-7; beyond, wrap_angle() comes first
float cos(float radians);       // likewise
float tan(float radians);       // relative error < 1e-6 where |sin| and |cos| > 1e-3
float atan(float x);            // absolute error < 3e-7
float atan2(float y, float x);  // in (-pi, pi], absolute error < 3e-7; atan2(0, 0) = 0; |x| + |y| must not overflow
float asin(float x);            // absolute error < 4e-7; x is clamped to [-1, 1]
float acos(float x);            // absolute error < 4e-7; x is clamped to [-1, 1]
float exp(float x);             // relative error < 3e-7; below -87: 0; above 88: 3.4e38
float log(float x);             // error < 2e-7 + 1e-7 |log x|; below the smallest normal number: its log, -87.33655

/// Both at the price of one.
struct SinCos {
  float sin;
  float cos;
};
SinCos sin_cos(float radians);

inline float abs(float x) { return __builtin_fabsf(x); }  // clears the sign bit: one instruction
/// sqrt(x*x + y*y), no protection against overflow.
inline float hypot(float x, float y) { return __builtin_sqrtf(x * x + y * y); }
inline float min(float a, float b) { return b < a ? b : a; }
inline float max(float a, float b) { return a < b ? b : a; }
inline float clamp(float x, float low, float high) { return min(max(x, low), high); }
inline float square(float x) { return x * x; }
/// NaN and both infinities are not finite.
inline bool is_finite(float x) { return x - x == 0.0F; }

}  // namespace touchline::math
