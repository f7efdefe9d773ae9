// SPDX-License-Identifier: Apache-2.0
// The field from above: carpet, lines, posts, and what is put on it.
#pragma once

#include <span>

#include "loc/field.h"
#include "platform/core/geometry.h"
#include "platform/host/canvas.h"

namespace touchline::host {

class FieldMap {
 public:
  /// Draws the field so that the carpet fills the box from (x, y) as far as the proportions allow.
  FieldMap(Canvas& canvas, const Field& field, int x, int y, int width, int height);

  [[nodiscard]] DrawPoint place(const FieldPoint& p) const;
  [[nodiscard]] float pixels_per_metre() const { return scale_; }

  void landmarks(Colour colour);
  void particles(std::span<const Pose2> poses, Colour colour, float radius_px = 2.0F);
  /// A disc and an arrow in the robot's direction.
  void pose(const Pose2& pose, Colour colour, float radius_m = 0.06F);
  void path(std::span<const Pose2> poses, Colour colour, int thickness = 1);

 private:
  void draw_field();

  Canvas& canvas_;
  const Field& field_;
  float scale_ = 1.0F;
  DrawPoint centre_;
};

}  // namespace touchline::host
