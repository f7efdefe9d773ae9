// SPDX-License-Identifier: Apache-2.0
// Growing seeds inside a mask, 64 pixels a word (geodesic reconstruction, Vincent 1993): cuts one blob out of a mask,
// and is the hysteresis of Canny without a stack that could run full.
#pragma once

#include "vision/image/bit_image.h"

namespace touchline {

struct GrowResult {
  int sweeps = 0;        // passes over the image, down and up in turn
  bool finished = true;  // false: the bound was reached; what was grown is right but not all
};

/// A path that turns at every row needs a sweep a turn; real blobs and edges take two to six.
constexpr int max_grow_sweeps(int width, int height) { return 2 * (width + height); }

/// Sets in `seeds` every pixel of `mask` that is 8-connected, inside the mask, to a seed. Seeds outside the mask are
/// removed.
GrowResult grow_inside(BitView seeds, ConstBitView mask);

}  // namespace touchline
