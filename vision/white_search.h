// SPDX-License-Identifier: Apache-2.0
// White search (paper section IV-C; reading: white by HSV between green on both sides, across the line's width). Two
// searches, for what a line is depends on how much of it the picture can hold:
//   spans: near lines, wide enough to have their own colour: white pixels between two green ones, as far apart as the
//   field says; ridges: far, thin or worn lines, whose colour melts with the carpet's: a pixel brighter and less green
//   than both sides.
// Both know no absolute brightness. Widths come from the table alone.
#pragma once

#include "vision/green.h"
#include "vision/image/bit_image.h"
#include "vision/image/grow.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/line_width_table.h"

namespace touchline {

/// Sets `lines` to every gap between two green pixels of a row or a column that is as wide as a line can be there,
/// mostly white, and brighter than both ends.
SpanCounts find_white_spans(const ConstYuv420View& image, ConstBitView green, ConstBitView white, LineWidthView widths,
                            const CarpetModel& carpet, BitView lines, const Kernels& kernels = portable_kernels());

/// Adds to `lines` the pixels of `roi` that stand out from the green on both sides, along the row or along the column,
/// by three times the noise; and those that stand out by half of that and hang together with such a one, or with a line
/// that is there already. Only where a line is at most `max_ridge_px` wide; beyond, spans find it. `scratch` has the
/// size of `lines` and holds all weak ridges afterwards. The result tells whether the growing ended within its bound.
GrowResult find_white_ridges(const ConstYuv420View& image, ConstBitView roi, ConstBitView green, LineWidthView widths,
                             const CarpetModel& carpet, BitView lines, BitView scratch,
                             const Kernels& kernels = portable_kernels());

}  // namespace touchline
