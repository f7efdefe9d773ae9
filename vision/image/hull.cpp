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

/// Where a side of the hull, from a corner down to another one, crosses the rows, one after the other.
class Side {
 public:
  Side(GridPoint from, GridPoint to) : rise_(to.y - from.y), x_(from.x) {
    const int run = to.x - from.x;
    step_ = run / rise_;
    step_rest_ = run % rise_;
    if (step_rest_ < 0) {  // floored; C++ rounds toward zero
      --step_;
      step_rest_ += rise_;
    }
  }
  void go_down() {
    x_ += step_;
    rest_ += step_rest_;
    if (rest_ >= rise_) {
      rest_ -= rise_;
      ++x_;
    }
  }
  [[nodiscard]] int rounded_down() const { return x_; }
  [[nodiscard]] int rounded_up() const { return rest_ > 0 ? x_ + 1 : x_; }

 private:
  int rise_, step_, step_rest_;
  int x_, rest_ = 0;  // x is x_ + rest_ / rise_
};

}  // namespace

int hull_of_points(std::span<GridPoint> points, std::span<GridPoint> out) {
  std::sort(points.begin(), points.end(), before);
  const auto end = std::unique(points.begin(), points.end());
  return hull_of_sorted(points.first(static_cast<std::size_t>(end - points.begin())), out);
}

int hull_of_mask(ConstBitView mask, std::span<GridPoint> scratch, std::span<GridPoint> out) {
  // The right side has the last pixels of rows, and the left side the first ones.
  const int words = words_for(mask.width);
  std::size_t lefts = 0;
  std::size_t size = 0;
  for (int y = 0; y < mask.height; ++y) {
    const BitWord* row = mask.row(y);
    int first = 0;
    int last = words - 1;
    while (first < words && row[first] == 0) ++first;
    if (first == words) continue;
    while (row[last] == 0) --last;
    const GridPoint left{static_cast<std::int16_t>(first * bits_per_word + std::countr_zero(row[first])),
                         static_cast<std::int16_t>(y)};
    const GridPoint right{
        static_cast<std::int16_t>(last * bits_per_word + bits_per_word - 1 - std::countl_zero(row[last])), left.y};
    scratch[lefts++] = left;
    const bool is_first = size == 0;
    if (is_first) out[size++] = left;
    if (!is_first || right != left) extend(out, size, 1, right);
  }
  if (size < 2) return static_cast<int>(size);
  const std::size_t bottom = size;
  if (scratch[lefts - 1] == out[size - 1]) --lefts;
  while (lefts > 0) extend(out, size, bottom, scratch[--lefts]);
  return static_cast<int>(size - 1);  // the last is the first again
}

void fill_hull(BitView mask, std::span<const GridPoint> hull) {
  if (hull.empty()) return;
  const std::size_t n = hull.size();
  const auto at = [&](std::size_t i) { return hull[i == n ? 0 : i]; };
  const int bottom = std::max_element(hull.begin(), hull.end(), [](auto a, auto b) { return a.y < b.y; })->y;
  const int top = hull[0].y;
  if (top == bottom) {
    set_span(mask, top, at(0).x, at(n - 1).x, true);
    return;
  }
  // The sides that cross the row: right from a corner down to the next, left from a corner down to the one before.
  std::size_t right = at(1).y == top ? 1 : 0;
  std::size_t left = n;
  Side right_side(at(right), at(right + 1));
  Side left_side(at(left), at(left - 1));
  for (int y = top;; ++y) {
    set_span(mask, y, left_side.rounded_up(), right_side.rounded_down(), true);
    if (y == bottom) return;
    if (at(right + 1).y == y) {
      ++right;
      right_side = Side(at(right), at(right + 1));
    }
    if (at(left - 1).y == y) {
      --left;
      left_side = Side(at(left), at(left - 1));
    }
    right_side.go_down();
    left_side.go_down();
  }
}

}  // namespace touchline
