// SPDX-License-Identifier: Apache-2.0
// Which landmarks a frame truly shows, and where: the truth that found junctions are judged by.
#pragma once

#include <string>
#include <vector>

#include "platform/host/sim/scenario.h"

namespace touchline::sim {

struct ExpectedLandmark {
  std::string type;  // X, T, L, P penalty mark, G goal post
  std::string name;
  FieldPoint world;
  PixelPoint px;             // camera pixels; of a post its axis at the ground
  PixelPoint front_foot_px;  // of a post: the nearest point of its foot
  float theta = 0.0F;        // from the optical axis, radians
  float range = 0.0F;        // from the robot, metres
  float bearing = 0.0F;      // from the robot's forward, left > 0, radians
  bool occluded = false;
};

inline constexpr float farthest_landmark = 4.0F;  // metres; those beyond are not listed

/// Those within the picture and `farthest_landmark`. `field` is that of the scene.
std::vector<ExpectedLandmark> expected_landmarks(const Field& field, const Scene& scene, const Lens& lens,
                                                 const SimFrame& frame);

}  // namespace touchline::sim
