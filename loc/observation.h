// SPDX-License-Identifier: Apache-2.0
// What one frame says about the pose, in the form that the likelihood and the refinement need. Data and its making.
#pragma once

#include <array>

#include "loc/localizer_config.h"
#include "platform/core/geometry.h"
#include "platform/core/static_vector.h"
#include "vision/vision_result.h"

namespace touchline {

/// A point on a line, with what it is worth.
struct LineSample {
  Vec3 ray;            // robot's axes, from the camera
  GroundPoint ground;  // with the attitude as given
  float dir_x = 1.0F;  // unit direction of the line on the ground, robot's frame
  float dir_y = 0.0F;
  float sigma = 0.0F;     // metres across the line: pixel and floor, not the tilt
  float variance = 0.0F;  // square metres across the line: sigma, and what one sigma of pitch and roll make
  float weight = 1.0F;    // independent measurements that it stands for; neighbours on one line share their errors
};

inline constexpr std::size_t max_line_samples = 512;
inline constexpr std::size_t max_filter_samples = 96;  // enough for 200 particles to tell poses apart; the rest refines

struct Observation {
  StaticVector<LineSample, max_line_samples> lines;
  StaticVector<LineSample, max_filter_samples> filter_lines;  // evenly spread part of `lines`, weights summed up
  float line_weight = 0.0F;                                   // sum of the weights of filter_lines
  CameraPose camera;
  const Features* features = nullptr;
};

/// Line points become samples when `config` lets lines be used. Length of line per independent measurement: a line's
/// points share calibration and paint errors, so that a metre of line is worth about seven measurements, not fifty.
inline constexpr float metres_per_measurement = 0.15F;

void make_observation(const VisionResult& vision, const LocalizerConfig& config, Observation& out);

}  // namespace touchline
