// SPDX-License-Identifier: Apache-2.0
// Where Canny's edges are looked for at all: the rest could add no line candidate (paper section IV-C).
#pragma once

#include "vision/image/bit_image.h"
#include "vision/image/kernels.h"
#include "vision/line_width_table.h"

namespace touchline {

struct EdgeZoneInput {
  ConstBitView white;
  ConstBitView green;
  ConstBitView region;  // no edge outside it
  ConstBitView lines;   // found already
  LineWidthView widths;
};

/// Sets `zone`, of the size of all masks: the pixels of the region within four pixels, along the row and the column, of
/// white at which an edge can tell more than white search did. Such white is neither a line nor beside one, and carpet
/// (green that is not white) ends it on both sides, along its row or its column, within longest_step() of its block:
/// any line does. A line's white begins within three pixels of its edge; the fourth lets weak edges lead to strong
/// ones.
void find_edge_zone(const EdgeZoneInput& input, BitView zone, const Kernels& kernels = portable_kernels());

}  // namespace touchline
