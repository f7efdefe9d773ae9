// SPDX-License-Identifier: Apache-2.0
// The loops of block_widths.h, written so that compilers vectorise them. Included by files of kernels and by
// line_width_table.cpp alone, and compiled there for that file's processor: everything is local to the file, and no
// function of another header is called.
//
// Of a block's four corner rays the sum is four times the ray of its centre, and the differences of sums are 16 times
// the steps to the next pixel: powers of two, which the last multiplication takes out again without rounding.
#pragma once

#include "vision/image/block_widths.h"
#include "vision/image/vector_registers.h"

namespace touchline {
namespace {
namespace block_widths {

struct Vector {
  float x, y, z;
};

/// Corners of a block: a b above, c d below.
struct Component {
  float a, b, c, d;
  [[gnu::always_inline]] Component(const float* above, const float* below, int i)
      : a(above[i]), b(above[i + 1]), c(below[i]), d(below[i + 1]) {}
  [[nodiscard]] [[gnu::always_inline]] float centre() const { return a + b + c + d; }          // 4 times
  [[nodiscard]] [[gnu::always_inline]] float along_row() const { return b - a - c + d; }       // 16 times the step
  [[nodiscard]] [[gnu::always_inline]] float along_column() const { return c - (a + b) + d; }  // likewise
};

[[gnu::always_inline]] inline std::int32_t has_ray(const float* const (&rays)[3], int i) {
  return rays[0][i] * rays[0][i] + rays[1][i] * rays[1][i] + rays[2][i] * rays[2][i] > 0.0F ? 1 : 0;
}

/// Which blocks have ground, or could. False when none has.
[[gnu::always_inline]] inline bool find_ground(const BlockRow& row, std::int32_t* ground) {
  constexpr float least_steepness = 0.02F;  // 50 camera heights away
  const float* m = row.robot_from_camera[2];
  std::int32_t any = 0;
  for (int i = 0; i < row.blocks; ++i) {
    const float z = m[0] * Component(row.above[0], row.below[0], i).centre() +
                    m[1] * Component(row.above[1], row.below[1], i).centre() +
                    m[2] * Component(row.above[2], row.below[2], i).centre();
    const std::int32_t seen =
        has_ray(row.above, i) & has_ray(row.above, i + 1) & has_ray(row.below, i) & has_ray(row.below, i + 1);
    ground[i] = seen & (z > -4.0F * least_steepness ? 0 : 1);
    any |= ground[i];
  }
  return any != 0;
}

[[gnu::always_inline]] inline float length(float x, float y) { return __builtin_sqrtf(x * x + y * y); }
[[gnu::always_inline]] inline std::int32_t rounded(float sixteenths) {
  const float x = sixteenths + 0.5F;
  return static_cast<std::int32_t>(x < 65535.0F ? x : 65535.0F);  // NaN: the most
}
[[gnu::always_inline]] inline Vector turned(const float (&m)[3][3], float a, float b, float c) {
  return {m[0][0] * a + m[0][1] * b + m[0][2] * c, m[1][0] * a + m[1][1] * b + m[1][2] * c,
          m[2][0] * a + m[2][1] * b + m[2][2] * c};
}

/// Rays and steps are turned into the robot's frame; how the ground point moves when the ray does follows from
/// ground = height * (x, y) / -z by the quotient rule: here 4 times the steps u and v, 16 times the area |det J|.
inline void measure(const BlockRow& given) {
  const BlockRow row = given;  // a copy that no store can change
  std::int32_t* __restrict ground = row.ground;
  std::int32_t* __restrict across_row = row.across_row;
  std::int32_t* __restrict across_column = row.across_column;
  std::int32_t* __restrict slanted = row.slanted;
  if (!find_ground(row, ground)) return;
  const auto& m = row.robot_from_camera;
  for (int i = 0; i < row.blocks; ++i) {
    if constexpr (!vector_registers) {
      if (ground[i] == 0) continue;
    }
    const Component x(row.above[0], row.below[0], i);
    const Component y(row.above[1], row.below[1], i);
    const Component z(row.above[2], row.below[2], i);
    const Vector ray = turned(m, x.centre(), y.centre(), z.centre());
    const Vector right = turned(m, x.along_row(), y.along_row(), z.along_row());
    const Vector down = turned(m, x.along_column(), y.along_column(), z.along_column());
    const float factor = row.height / (ray.z * ray.z);
    const float ux = factor * (ray.x * right.z - right.x * ray.z);
    const float uy = factor * (ray.y * right.z - right.y * ray.z);
    const float vx = factor * (ray.x * down.z - down.x * ray.z);
    const float vy = factor * (ray.y * down.z - down.y * ray.z);
    const float area = __builtin_fabsf(ux * vy - uy * vx);
    const float scale = row.line_width_m / area;
    ground[i] &= area > 0.0F ? 1 : 0;
    across_row[i] = rounded(scale * length(vx, vy) * 64.0F);
    across_column[i] = rounded(scale * length(ux, uy) * 64.0F);
    const float falling = length(ux + vx, uy + vy);
    const float rising = length(ux - vx, uy - vy);
    slanted[i] = rounded(scale * (falling < rising ? rising : falling) * 64.0F);
  }
}

}  // namespace block_widths
}  // namespace
}  // namespace touchline
