// SPDX-License-Identifier: Apache-2.0
// Erosion and dilation of a mask with a square kernel, in place, 64 pixels a word (paper section IV-B and IV-C).
#pragma once

#include "vision/image/bit_image.h"

namespace touchline {

/// The widest mask: bounds the three rolling rows on the stack (480 bytes).
inline constexpr int max_mask_width = 1280;

/// A kernel of the same results (kernels.h): joins each pixel with the square of side 3 around it, `passes` times.
/// False when it does not take masks of that width; nothing was changed then.
using JoinSquares = bool (*)(BitView mask, bool dilate, int passes);

/// A pixel is set when any pixel of the square of `kernel_side` around it is set. Outside the image counts as zero.
/// `kernel_side` is odd; 1 (and less) changes nothing. Cost grows with kernel_side / 2. mask.width <= max_mask_width.
void dilate(BitView mask, int kernel_side, JoinSquares kernel = nullptr);

/// A pixel stays when all pixels of the square that are inside the image are set: outside does not erode, so that a
/// field that reaches the image's border keeps its border. Same limits as dilate().
void erode(BitView mask, int kernel_side, JoinSquares kernel = nullptr);

}  // namespace touchline
