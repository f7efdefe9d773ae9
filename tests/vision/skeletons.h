// SPDX-License-Identifier: Apache-2.0
// Skeletons for the tests of digestion and node graph: drawn ones, and seeded random ones (walks, grids, thinned
// noise).
#pragma once

#include "tests/support/ascii_image.h"

namespace touchline::test {

Bits drawn_x();
Bits drawn_l();
Bits drawn_circle(int width, int height, int radius);
/// Thinned from a picture that the seed chooses: random walks, a grid with jitter, noise, or all of them.
Bits random_skeleton(unsigned seed);

}  // namespace touchline::test
