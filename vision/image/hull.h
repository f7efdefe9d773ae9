// SPDX-License-Identifier: Apache-2.0
// Convex hull of pixels, exact in integers (Andrew's monotone chain, 1979), and the hull filled as a region of interest
// (paper section IV-B).
#pragma once

#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/grid_point.h"

namespace touchline {

/// A hull of pixels in `height` rows has at most two corners a row.
constexpr int max_hull_points(int height) { return 2 * height; }

/// Corners of the convex hull of `points`, without those that lie on its sides: from the topmost point (the left one of
/// several) clockwise on the screen. Sorts `points`, in place. Needs out.size() >= max_hull_points(rows that the points
/// span) + 1, which is asserted as it goes. Returns how many corners there are.
int hull_of_points(std::span<GridPoint> points, std::span<GridPoint> out);

/// The same for all set pixels of a mask, in time proportional to its words. `scratch` and `out` have
/// max_hull_points(mask.height) + 1 elements or more.
int hull_of_mask(ConstBitView mask, std::span<GridPoint> scratch, std::span<GridPoint> out);

/// Sets the pixels whose centres lie in the hull or on its border; others stay as they are. The hull may reach outside.
void fill_hull(BitView mask, std::span<const GridPoint> hull);

}  // namespace touchline
