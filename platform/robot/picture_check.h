// SPDX-License-Identifier: Apache-2.0
// Whether a picture shows anything at all: a lens cap and a dead sensor look alike.
#pragma once

#include <cstdint>

#include "platform/core/frame.h"

namespace touchline {

/// The brightest of about 1,000 pixels on a grid, by green or luma, 0..255. A frame without data gives 0.
std::uint8_t brightest_sample(const FrameView& frame);

}  // namespace touchline
