// SPDX-License-Identifier: Apache-2.0
// The camera's frame as working image where both have one size and the frame is YUYV already, as on microcontrollers:
// no weights, no rows between. The samples are those that Subsampler's general way gives.
#pragma once

#include "vision/image/frame.h"
#include "vision/image/image_view.h"

namespace touchline {

/// YUYV of even size, `out` of the same size. Chroma is the mean of two rows, luma is stretched to full range.
void stretch_yuyv(const FrameView& frame, const Yuv420View& out);

}  // namespace touchline
