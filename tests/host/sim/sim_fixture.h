// SPDX-License-Identifier: Apache-2.0
// Scenes for the simulator's tests.
#pragma once

#include "platform/host/sim/scenario.h"

namespace touchline::sim {

inline FieldDimensions small_field() {
  FieldDimensions f;
  f.length = 4.9F;
  f.width = 2.9F;
  f.line_width = 0.10F;
  f.circle_radius = 0.5F;
  f.goal_area_depth = 0.4F;
  f.goal_area_width = 1.8F;
  f.penalty_area_depth = 0.0F;
  f.penalty_area_width = 0.0F;
  f.penalty_mark = 1.2F;
  f.goal_width = 1.2F;
  f.goal_height = 1.0F;
  f.border = 0.65F;
  return f;
}

/// Carpet, lines and goals alone, under even light, with no texture.
inline SceneOptions plain_scene(const FieldDimensions& field) {
  SceneOptions o;
  o.field = field;
  o.ground.carpet = rgb8(40, 110, 60);
  o.ground.paint = rgb8(215, 215, 215);
  o.ground.floor = rgb8(120, 120, 120);
  o.ground.grain = 0.0F;
  o.ground.ragged = 0.0F;
  o.ground.debris = 0;
  o.ground.floor_line_inset = 0.0F;
  o.clutter = false;
  o.ball = false;
  return o;
}

inline ImageEffects no_effects() {
  ImageEffects e;
  e.blur_px = 0.0F;
  e.noise = 0.0F;
  e.vignetting = 0.0F;
  return e;
}

}  // namespace touchline::sim
