// SPDX-License-Identifier: Apache-2.0
// The simulator's small arithmetic: vectors, and colours in linear light. Only + - * / and sqrt and our own elementary
// functions, so that a simulated frame is the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "platform/core/elementary.h"
#include "platform/core/geometry.h"

namespace touchline::sim {

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(const Vec3& a, float s) { return {a.x * s, a.y * s, a.z * s}; }

/// Inline, since it runs several times a pixel; correctly rounded everywhere, so no less the same.
inline float square_root(float x) { return std::sqrt(x); }
inline float length(float x, float y) { return std::sqrt(x * x + y * y); }

/// Linear light; 1 is what the sensor shows as 255.
struct Rgb {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;
};
inline Rgb operator*(const Rgb& a, const Rgb& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
inline Rgb operator*(const Rgb& a, float s) { return {a.r * s, a.g * s, a.b * s}; }
inline Rgb operator+(const Rgb& a, const Rgb& b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
inline Rgb mix(const Rgb& a, const Rgb& b, float t) { return a + (b + a * -1.0F) * t; }

/// The linear colour that the simulated camera shows as these 8-bit values. Its gamma is 2: close to what cameras have,
/// and a square root is exact on every machine.
inline Rgb rgb8(int r, int g, int b) {
  const auto channel = [](int c) { return math::square(static_cast<float>(c) / 255.0F); };
  return {channel(r), channel(g), channel(b)};
}

/// A hash of small integers, for patterns that need no memory. In [0, 1).
inline float cell_random(int x, int y, std::uint32_t seed) {
  std::uint32_t h = static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ seed;
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  h ^= h >> 12U;
  h *= 0x297A2D39U;
  h ^= h >> 15U;
  return static_cast<float>(h >> 8U) * (1.0F / 16777216.0F);
}

inline int floor_int(float x) {
  const int i = static_cast<int>(x);
  return x < static_cast<float>(i) ? i - 1 : i;
}

/// The part of [x - half, x + half] that lies in [low, high], 0..1: the analytic coverage of a pixel by a stripe.
inline float covered(float x, float half, float low, float high) {
  const float a = math::max(x - half, low);
  const float b = math::min(x + half, high);
  return b <= a ? 0.0F : (b - a) / (2.0F * half);
}

}  // namespace touchline::sim
