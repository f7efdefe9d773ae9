// SPDX-License-Identifier: Apache-2.0
// Second moments of a mask's pixels around one of them (Horn, "Robot Vision", section 3.3), from which a line's
// direction comes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vision/image/bit_image.h"
#include "vision/image/grid_point.h"

namespace touchline {

/// Pixels, and the sums of their columns, rows and products, all relative to the middle pixel.
struct Moments {
  std::int32_t n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  bool operator==(const Moments&) const = default;
};

/// A square window of 2 radius + 1 pixels inside a mask: pixel x of a row is bit `shift` + x of the four bytes there.
struct MomentWindow {
  const std::uint8_t* bytes = nullptr;  // of the first row
  std::ptrdiff_t stride = 0;
  int shift = 0;   // 0 to 7
  int radius = 0;  // 1 to max_window_radius
};
inline constexpr int max_window_radius = 10;  // 7 bits of shift and 21 pixels are 28 bits of 32

/// The window of `radius` around `at`; false when it is not wholly inside the mask's memory.
bool make_window(ConstBitView mask, GridPoint at, int radius, MomentWindow& window);

struct Kernels;
/// Of the pixels of the square 2 radius + 1 around `at` that lie in the image. Radius 1 to 15.
Moments moments_around(ConstBitView mask, GridPoint at, int radius, const Kernels& kernels);

}  // namespace touchline
