// SPDX-License-Identifier: Apache-2.0
// Second moments of a mask's pixels around one of them (Horn, "Robot Vision", section 3.3), from which a line's
// direction comes.
#pragma once

#include <array>
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

constexpr Moments operator+(const Moments& a, const Moments& b) {
  return {a.n + b.n, a.x + b.x, a.y + b.y, a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
/// The same pixels about a middle that lies dx columns to the left.
constexpr Moments moved(const Moments& m, int dx) {
  return {m.n, m.x + dx * m.n, m.y, m.xx + 2 * dx * m.x + dx * dx * m.n, m.xy + dx * m.y, m.yy};
}

inline constexpr int max_moments_radius = 15;
inline constexpr int max_window_columns = 21;  // three patterns of seven; with 7 bits of shift, 28 bits of 32

/// Columns of a window, counted from the pixel that it is about.
struct WindowColumns {
  int first = 0;
  int count = 0;  // 1 to max_window_columns
  [[nodiscard]] constexpr int middle() const { return first + count / 2; }
};
/// The columns -radius..radius in one or two parts of at most max_window_columns.
struct WindowParts {
  std::array<WindowColumns, 2> part;
  int count = 0;
};
constexpr WindowParts parts_of(int radius) {
  if (2 * radius + 1 <= max_window_columns) return {{{{-radius, 2 * radius + 1}, {}}}, 1};
  return {{{{-radius, radius + 1}, {1, radius}}}, 2};
}

/// A window of `columns` x (2 radius + 1) pixels inside a mask: pixel x of a row is bit `shift` + x of the four bytes
/// there. Its moments are about column columns / 2 of its middle row.
struct MomentWindow {
  const std::uint8_t* bytes = nullptr;  // of the first row
  std::ptrdiff_t stride = 0;
  int shift = 0;    // 0 to 7
  int columns = 0;  // 1 to max_window_columns
  int radius = 0;   // 1 to max_moments_radius
};

/// The window of some columns about `at`; false when it is not wholly inside the mask's memory.
bool make_window(ConstBitView mask, GridPoint at, WindowColumns columns, int radius, MomentWindow& window);

struct Kernels;
/// Of the pixels of the square 2 radius + 1 around `at` that lie in the image. Radius 1 to max_moments_radius.
Moments moments_around(ConstBitView mask, GridPoint at, int radius, const Kernels& kernels);

}  // namespace touchline
