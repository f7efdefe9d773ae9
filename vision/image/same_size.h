// SPDX-License-Identifier: Apache-2.0
// The camera's frame as working image where both have one size, as on microcontrollers: no weights, no sums between.
// The samples are those that Subsampler's general way gives.
#pragma once

#include <cstdint>
#include <span>

#include "vision/image/colour_matrix.h"
#include "vision/image/frame.h"
#include "vision/image/image_view.h"

namespace touchline {

/// YUYV of even size, `out` of the same size. Chroma is the mean of two rows, luma is stretched to full range.
void stretch_yuyv(const FrameView& frame, const Yuv420View& out);

/// Two rows of three interleaved bytes a pixel, an even number of them, and where their samples go.
struct RowPair {
  const std::uint8_t* source[2] = {};
  int columns = 0;
  ColourMatrix matrix;
  std::uint8_t* y[2] = {};
  std::uint8_t* cb = nullptr;
  std::uint8_t* cr = nullptr;
};
using ChangeRows = void (*)(const RowPair& rows);

/// Any format but YUYV, of even size, `out` of the same. `buffer` has six bytes a column, for formats that are
/// unpacked.
void change_frame(const FrameView& frame, ChangeRows change, std::span<std::uint8_t> buffer, const Yuv420View& out);

}  // namespace touchline
