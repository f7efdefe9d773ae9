// SPDX-License-Identifier: Apache-2.0
// Plays a recorded sequence from pixels to poses and prints a hash of every product, as the golden outputs do: the same
// source runs on a microcontroller and on the host, and both have to print the same.
#pragma once

#include <array>
#include <cstdint>

#include "loc/localizer.h"
#include "platform/cortex_m/recording.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace touchline::board {

/// All memory of the program but its stack: the sensor's frame, vision and localization.
struct Chain {
  std::array<std::uint8_t, frame_bytes> frame{};  // where the camera's DMA would put it
  PipelineStorage<320, 240, 1, frame_width> storage{};
  Pipeline pipeline{storage.memory()};
  Localizer localizer{};
  VisionResult vision{};
};

/// Plays the whole recording; false when something refuses it (then it has said what).
bool play(const Recording& recording, Chain& chain);

}  // namespace touchline::board
