// SPDX-License-Identifier: Apache-2.0
// A plain picture of a field for tests of the whole chain that need no host tools: green carpet with a grain, white
// lines, grey surroundings. No light, no blur: a test of order and memory, not of accuracy.
#pragma once

#include <cstdint>
#include <span>

#include "loc/field.h"
#include "platform/core/geometry.h"
#include "vision/lens/camera_pose.h"

namespace touchline::test {

/// Draws what the camera of a robot at `robot` sees into `rgb` (RGB24, width * height * 3 bytes).
void draw_field(const Field& field, const GroundProjection& projection, const Pose2& robot, int width, int height,
                std::span<std::uint8_t> rgb);

}  // namespace touchline::test
