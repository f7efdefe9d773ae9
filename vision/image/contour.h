// SPDX-License-Identifier: Apache-2.0
// The outer border of a blob as a polyline, by border following (Suzuki and Abe, "Topological Structural Analysis of
// Digitized Binary Images by Border Following", CVGIP 30, 1985, algorithm 1, steps 3.1 to 3.5; paper section IV-B).
#pragma once

#include <span>

#include "vision/image/bit_image.h"
#include "vision/image/grid_point.h"

namespace touchline {

struct Contour {
  int points = 0;   // corners written
  int dropped = 0;  // corners that found no room; the polyline is cut off there
  int length = 0;   // steps from pixel to pixel around the blob; 0 for a single pixel
};

/// Follows the outer border of the 8-connected blob whose first pixel in raster order is `first`, counter-clockwise on
/// the screen, and writes the pixels where its direction changes, beginning with `first`. At most one step for each of
/// a pixel's eight sides, so the time is bounded by the border's length. `first` must be set and have nothing set to
/// its left.
Contour trace_contour(ConstBitView mask, GridPoint first, std::span<GridPoint> out);

}  // namespace touchline
