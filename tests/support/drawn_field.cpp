// SPDX-License-Identifier: Apache-2.0
#include "tests/support/drawn_field.h"

#include "platform/core/elementary.h"

namespace touchline::test {
namespace {

float distance_to_segment(const FieldPoint& p, const FieldLine& line) {
  const float dx = line.b.x - line.a.x;
  const float dy = line.b.y - line.a.y;
  const float along = ((p.x - line.a.x) * dx + (p.y - line.a.y) * dy) / (dx * dx + dy * dy);
  const float t = math::clamp(along, 0.0F, 1.0F);
  return math::hypot(p.x - line.a.x - t * dx, p.y - line.a.y - t * dy);
}

bool on_line(const Field& field, const FieldPoint& p) {
  const float half_width = field.dimensions().line_width * 0.5F;
  for (const FieldLine& line : field.lines()) {
    if (distance_to_segment(p, line) < half_width) return true;
  }
  return math::abs(math::hypot(p.x, p.y) - field.dimensions().circle_radius) < half_width;
}

/// 0..15, the carpet's grain.
int grain(int x, int y) {
  const auto n = static_cast<std::uint32_t>(x) * 73856093U ^ static_cast<std::uint32_t>(y) * 19349663U;
  return static_cast<int>((n * 2654435761U) >> 28U);
}

}  // namespace

void draw_field(const Field& field, const GroundProjection& projection, const Pose2& robot, int width, int height,
                std::span<std::uint8_t> rgb) {
  std::size_t at = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x, at += 3) {
      int color[3] = {95, 92, 90};  // the hall
      GroundPoint ground;
      if (projection.ground({static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F}, ground)) {
        const FieldPoint p = to_field(robot, ground);
        const bool carpet = math::abs(p.x) < field.half_carpet_length() && math::abs(p.y) < field.half_carpet_width();
        const int shade = grain(x, y);
        if (carpet && on_line(field, p)) {
          for (int& c : color) c = 225 + shade;
        } else if (carpet) {
          color[0] = 35 + shade;
          color[1] = 120 + shade;
          color[2] = 45 + shade;
        }
      }
      for (std::size_t i = 0; i < 3; ++i) rgb[at + i] = static_cast<std::uint8_t>(color[i]);
    }
  }
}

}  // namespace touchline::test
