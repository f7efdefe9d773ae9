// SPDX-License-Identifier: Apache-2.0
// Where Canny's edges are looked for at all: elsewhere they add next to nothing to the lines (paper section IV-C).
#pragma once

#include "vision/image/bit_image.h"
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
/// (green that is not white) lies on both sides of it, along its row or its column, no farther than longest_step()
/// (line_extent.h): the largest that any such white of the same 64 pixels of its row has, and where that is 64 or more,
/// carpet is not asked for. A line does end in carpet; what does not is floor, a robot or a board, and what the
/// picture's border cuts. A line's white begins within three pixels of its edge; the fourth lets weak edges lead to
/// strong ones.
void find_edge_zone(const EdgeZoneInput& input, BitView zone);

}  // namespace touchline
