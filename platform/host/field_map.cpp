// SPDX-License-Identifier: Apache-2.0
// The field from above.
#include "platform/host/field_map.h"

#include <algorithm>
#include <cmath>

namespace touchline::host {
namespace {

FieldPoint ahead(const Pose2& pose, float metres) {
  return {pose.x + metres * std::cos(pose.theta), pose.y + metres * std::sin(pose.theta)};
}

}  // namespace

FieldMap::FieldMap(Canvas& canvas, const Field& field, int x, int y, int width, int height)
    : canvas_(canvas), field_(field) {
  const float metres_long = 2.0F * field.half_carpet_length();
  const float metres_wide = 2.0F * field.half_carpet_width();
  scale_ = std::min(static_cast<float>(width) / metres_long, static_cast<float>(height) / metres_wide);
  centre_ = {static_cast<float>(x) + static_cast<float>(width) * 0.5F,
             static_cast<float>(y) + static_cast<float>(height) * 0.5F};
  draw_field();
}

DrawPoint FieldMap::place(const FieldPoint& p) const { return {centre_.x + p.x * scale_, centre_.y - p.y * scale_}; }

void FieldMap::draw_field() {
  const DrawPoint corner = place({-field_.half_carpet_length(), field_.half_carpet_width()});
  canvas_.rectangle(static_cast<int>(corner.x), static_cast<int>(corner.y),
                    static_cast<int>(2.0F * field_.half_carpet_length() * scale_),
                    static_cast<int>(2.0F * field_.half_carpet_width() * scale_), colours::carpet);
  const auto& d = field_.dimensions();
  const int thickness = std::max(1, static_cast<int>(std::lround(d.line_width * scale_)));
  for (const auto& line : field_.lines()) canvas_.line(place(line.a), place(line.b), colours::white, thickness);
  canvas_.circle(place({0.0F, 0.0F}), d.circle_radius * scale_, colours::white, thickness);
  if (d.penalty_mark > 0.0F) {
    const float mark = d.length * 0.5F - d.penalty_mark;
    for (const float x : {-mark, mark})
      canvas_.disc(place({x, 0.0F}), std::max(1.5F, d.line_width * scale_), colours::white);
  }
  for (const auto& post : field_.posts()) {
    canvas_.disc(place(post), std::max(2.5F, d.post_diameter * 0.5F * scale_), colours::yellow);
  }
}

void FieldMap::landmarks(Colour colour) {
  for (const auto& landmark : field_.landmarks()) {
    const DrawPoint at = place(landmark.at);
    canvas_.circle(at, 6.0F, colour, 2);
    canvas_.label(static_cast<int>(at.x) + 9, static_cast<int>(at.y) - 18, to_string(landmark.type), colour, 2);
  }
}

void FieldMap::particles(std::span<const Pose2> poses, Colour colour, float radius_px) {
  for (const auto& pose : poses) {
    const DrawPoint at = place({pose.x, pose.y});
    canvas_.line(at, place(ahead(pose, 4.0F * radius_px / scale_)), colour);
    canvas_.disc(at, radius_px, colour);
  }
}

void FieldMap::pose(const Pose2& pose, Colour colour, float radius_m) {
  const float radius = std::max(3.0F, radius_m * scale_);
  canvas_.disc(place({pose.x, pose.y}), radius, colour);
  canvas_.arrow(place({pose.x, pose.y}), place(ahead(pose, 3.0F * radius / scale_)), colour, 2);
}

void FieldMap::path(std::span<const Pose2> poses, Colour colour, int thickness) {
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const auto& a = poses[i - 1];
    const auto& b = poses[i];
    if (std::hypot(a.x - b.x, a.y - b.y) > 0.3F) continue;  // a kidnap or a lost pose: no line across the field
    canvas_.line(place({a.x, a.y}), place({b.x, b.y}), colour, thickness);
  }
}

}  // namespace touchline::host
