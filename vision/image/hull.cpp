// SPDX-License-Identifier: Apache-2.0
// Convex hull by monotone chain over points sorted by rows: down the right side, up the left one.
#include "vision/image/hull.h"

#include <algorithm>
#include <bit>

#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

/// > 0: from o, b lies clockwise of a on the screen (y grows downward).
std::int32_t cross(GridPoint o, GridPoint a, GridPoint b) {
  return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x);
}

bool before(GridPoint a, GridPoint b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

/// Takes the corners at and after `keep` off again that p makes superfluous, then adds p.
void extend(std::span<GridPoint> hull, std::size_t& size, std::size_t keep, GridPoint p) {
  while (size > keep && cross(hull[size - 2], hull[size - 1], p) <= 0) --size;
  assert(size < hull.size());
  hull[size++] = p;
}

/// `points` sorted by before(), without duplicates.
int hull_of_sorted(std::span<const GridPoint> points, std::span<GridPoint> out) {
  if (points.empty()) return 0;
  out[0] = points[0];
  std::size_t size = 1;
  for (std::size_t i = 1; i < points.size(); ++i) extend(out, size, 1, points[i]);
  const std::size_t bottom = size;
  for (std::size_t i = points.size() - 1; i-- > 0;) extend(out, size, bottom, points[i]);
  return static_cast<int>(size > 1 ? size - 1 : size);  // the last is the first again
}

/// Where the side a-b (a.y < b.y) crosses row y, rounded up or down.
int crossing(GridPoint a, GridPoint b, int y, bool round_up) {
  const int rise = b.y - a.y;
  const int run = (b.x - a.x) * (y - a.y);
  // Floored division; C++ rounds toward zero.
  const int numerator = round_up ? run + rise - 1 : run;
  const int quotient = numerator >= 0 ? numerator / rise : -((-numerator + rise - 1) / rise);
  return a.x + quotient;
}

}  // namespace

int hull_of_points(std::span<GridPoint> points, std::span<GridPoint> out) {
  std::sort(points.begin(), points.end(), before);
  const auto end = std::unique(points.begin(), points.end());
  return hull_of_sorted(points.first(static_cast<std::size_t>(end - points.begin())), out);
}

int hull_of_mask(ConstBitView mask, std::span<GridPoint> scratch, std::span<GridPoint> out) {
  const int words = words_for(mask.width);
  std::size_t count = 0;
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    int first = 0;
    int last = words - 1;
    while (first < words && row[first] == 0) ++first;
    if (first == words) continue;
    while (row[last] == 0) --last;
    const int left = first * bits_per_word + std::countr_zero(row[first]);
    const int right = last * bits_per_word + bits_per_word - 1 - std::countl_zero(row[last]);
    scratch[count++] = {static_cast<std::int16_t>(left), static_cast<std::int16_t>(y)};
    if (right != left) scratch[count++] = {static_cast<std::int16_t>(right), static_cast<std::int16_t>(y)};
  }
  return hull_of_sorted(scratch.first(count), out);
}

void fill_hull(BitView mask, std::span<const GridPoint> hull) {
  if (hull.empty()) return;
  const std::size_t n = hull.size();
  const auto at = [&](std::size_t i) { return hull[i % n]; };
  const int bottom = std::max_element(hull.begin(), hull.end(), [](auto a, auto b) { return a.y < b.y; })->y;
  const int top = hull[0].y;
  // The sides that cross the row: right from a corner down to the next, left from a corner down to the one before.
  std::size_t right = at(1).y == top ? 1 : 0;
  std::size_t left = n;
  for (int y = top; y <= bottom; ++y) {
    if (top == bottom) {
      set_span(mask, y, at(0).x, at(n - 1).x, true);
      return;
    }
    while (at(right + 1).y < y) ++right;
    while (at(left - 1).y < y) --left;
    set_span(mask, y, crossing(at(left), at(left - 1), y, true), crossing(at(right), at(right + 1), y, false), true);
  }
}

}  // namespace touchline
