// SPDX-License-Identifier: Apache-2.0
// One row of a frame as three interleaved bytes a pixel, whatever the camera sends.
#pragma once

#include "vision/image/frame.h"

namespace touchline {

/// Whether the camera's rows are three interleaved bytes already, so that unpack_row() needs no buffer.
constexpr bool needs_no_unpacking(PixelFormat f) { return f == PixelFormat::rgb24 || f == PixelFormat::bgr24; }

/// The first pixels of a row by vectors; each returns how many. Null: not offered.
struct UnpackKernels {
  int (*yuyv)(const std::uint8_t* row, int width, std::uint8_t* out) = nullptr;
  int (*rgb565)(const std::uint8_t* row, int width, std::uint8_t* out) = nullptr;
};

/// Row y of the frame as width * 3 bytes: R G B, B G R, or (yuyv) Y Cb Cr with each chroma sample for both of its
/// pixels. Where the camera's bytes are already so, they are returned in place; else they go to `buffer` of width * 3.
const std::uint8_t* unpack_row(const FrameView& frame, int y, std::uint8_t* buffer, const UnpackKernels& kernels = {});

}  // namespace touchline
