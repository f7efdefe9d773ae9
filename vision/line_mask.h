// SPDX-License-Identifier: Apache-2.0
// From candidates to the line mask, with the paper's dilation and erosion: what belongs to a line and was not found,
// and what was found and does not belong to it.
#pragma once

#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/line_width_table.h"

namespace touchline {

/// Takes pixels off the border of `lines` whose luma is nearer to the carpet's than to the line's (the darkest and the
/// brightest within two pixels): what blur and the coarser chroma let in. Two passes. `scratch` has the same size.
void trim_to_half_level(ImageView<const std::uint8_t> luma, BitView lines, BitView scratch,
                        const Kernels& kernels = portable_kernels());

/// Lets `lines` grow inside `white` by half a line's width: fills the crossings of lines, which are wider than a line,
/// and the rest of a line that the picture's border cuts. `scratch` has the same size.
void grow_into_white(ConstBitView white, LineWidthView widths, BitView lines, BitView scratch,
                     const Kernels& kernels = portable_kernels());

/// The paper's dilation and erosion (section IV-C), sides in pixels: joins both edges of a line and closes its breaks.
/// What they add and has the carpet's colour is taken out again: two lines that meet at a sharp angle, or run a pixel
/// apart, stay two up to where no carpet is seen between them. `scratch` has the same size.
void close_lines(ConstBitView carpet, int dilate_px, int erode_px, BitView lines, BitView scratch,
                 const Kernels& kernels = portable_kernels());

}  // namespace touchline
