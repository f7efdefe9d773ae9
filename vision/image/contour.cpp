// SPDX-License-Identifier: Apache-2.0
// Border following. Directions are counted clockwise on the screen from east: 0 E, 1 SE, 2 S, 3 SW, 4 W, 5 NW, 6 N, 7
// NE.
#include "vision/image/contour.h"

#include <cassert>

namespace touchline {
namespace {

GridPoint step(GridPoint p, int direction) {
  constexpr std::int8_t dx[8] = {1, 1, 0, -1, -1, -1, 0, 1};
  constexpr std::int8_t dy[8] = {0, 1, 1, 1, 0, -1, -1, -1};
  return {static_cast<std::int16_t>(p.x + dx[direction]), static_cast<std::int16_t>(p.y + dy[direction])};
}

/// The first set neighbour when turning from direction `from` (itself not looked at) by `turn` (+1 clockwise); -1:
/// none.
int find_neighbour(ConstBitView mask, GridPoint p, int from, int turn) {
  for (int i = 1; i <= 8; ++i) {
    const int direction = (from + turn * i) & 7;
    const GridPoint q = step(p, direction);
    if (mask.get(q.x, q.y)) return direction;
  }
  return -1;
}

}  // namespace

Contour trace_contour(ConstBitView mask, GridPoint first, std::span<GridPoint> out) {
  assert(mask.get(first.x, first.y) && !mask.get(first.x - 1, first.y));
  Contour contour;
  const auto add = [&](GridPoint p) {
    if (static_cast<std::size_t>(contour.points) < out.size()) {
      out[static_cast<std::size_t>(contour.points++)] = p;
    } else {
      ++contour.dropped;
    }
  };
  add(first);
  constexpr int west = 4;
  const int to_last = find_neighbour(mask, first, west, +1);  // 3.1: where the border will come back from
  if (to_last < 0) return contour;
  const GridPoint last = step(first, to_last);

  GridPoint here = first;
  int back = to_last;  // from `here` to the pixel before it
  int heading = -1;    // of the step that led here
  const int bound = 8 * mask.width * mask.height;
  while (contour.length < bound) {
    const int next = find_neighbour(mask, here, back, -1);  // 3.3: counter-clockwise; finds at least the pixel before
    if (heading >= 0 && next != heading) add(here);
    const GridPoint ahead = step(here, next);
    ++contour.length;
    if (ahead == first && here == last) break;  // 3.5
    here = ahead;
    heading = next;
    back = (next + 4) & 7;
  }
  return contour;
}

}  // namespace touchline
