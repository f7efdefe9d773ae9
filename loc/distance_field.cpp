// SPDX-License-Identifier: Apache-2.0
#include "loc/distance_field.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float far_away = 1.0e9F;  // square metres; more than any distance on a field

bool runs_along_x(const FieldLine& line) { return line.a.y == line.b.y; }

/// All lines of a field run along x or y, so the nearest point of a segment is a clamped coordinate.
FieldPoint nearest_on(const FieldLine& line, const FieldPoint& p) {
  if (runs_along_x(line))
    return {math::clamp(p.x, math::min(line.a.x, line.b.x), math::max(line.a.x, line.b.x)), line.a.y};
  return {line.a.x, math::clamp(p.y, math::min(line.a.y, line.b.y), math::max(line.a.y, line.b.y))};
}

float squared_distance(const FieldPoint& a, const FieldPoint& b) {
  return math::square(a.x - b.x) + math::square(a.y - b.y);
}

/// Is the circle's tangent near p within 67.5 degrees of the axis? The radius stands at right angles to it.
bool circle_counts(const FieldPoint& p, LineAxis axis) {
  constexpr float tan_67_5 = 2.41421356F;
  const float across = axis == LineAxis::x ? math::abs(p.y) : math::abs(p.x);
  const float along = axis == LineAxis::x ? math::abs(p.x) : math::abs(p.y);
  return along <= tan_67_5 * across;
}

float exact_distance(const Field& field, const FieldPoint& p, LineAxis axis) {
  float best = far_away;
  for (const FieldLine& line : field.lines()) {
    if (runs_along_x(line) == (axis == LineAxis::x)) best = math::min(best, squared_distance(p, nearest_on(line, p)));
  }
  const float radius = field.dimensions().circle_radius;
  if (radius > 0.0F && circle_counts(p, axis)) {
    best = math::min(best, math::square(math::hypot(p.x, p.y) - radius));
  }
  return math::sqrt(best);
}

/// To the nearest step, at most the cap's 255.
std::uint8_t quantised(float distance) {
  const float half_steps = math::min(distance, DistanceField::cap) * (2.0F / DistanceField::unit);
  return static_cast<std::uint8_t>((static_cast<int>(half_steps) + 1) / 2);
}

/// Straight lines are compared with `use_x` and `use_y`: whether lines along that axis take part.
LineMatch nearest_straight(const Field& field, const FieldPoint& p, bool use_x, bool use_y, float& best) {
  LineMatch match;
  FieldPoint foot;
  best = far_away;
  const auto lines = field.lines();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (!(runs_along_x(lines[i]) ? use_x : use_y)) continue;
    const FieldPoint candidate = nearest_on(lines[i], p);
    const float squared = squared_distance(p, candidate);
    if (squared >= best) continue;
    best = squared;
    foot = candidate;
    match.line = static_cast<int>(i);
  }
  if (match.line < 0) return match;
  // Beside the line the normal is the axis, so that the distance passes smoothly through zero. Beyond its end the
  // normal points from the end to the point.
  const bool along_x = runs_along_x(lines[static_cast<std::size_t>(match.line)]);
  const float beyond = along_x ? p.x - foot.x : p.y - foot.y;
  if (beyond == 0.0F) {
    match.normal_x = along_x ? 0.0F : 1.0F;
    match.normal_y = along_x ? 1.0F : 0.0F;
    match.distance = along_x ? p.y - foot.y : p.x - foot.x;
  } else {
    match.distance = math::sqrt(best);
    match.normal_x = (p.x - foot.x) / match.distance;
    match.normal_y = (p.y - foot.y) / match.distance;
  }
  return match;
}

/// At the centre mark itself every point of the circle is equally near: the normal is then (1, 0).
LineMatch on_circle(float radius, const FieldPoint& p, float from_centre) {
  LineMatch match;
  match.line = LineMatch::circle;
  match.distance = from_centre - radius;
  match.normal_x = from_centre > 0.0F ? p.x / from_centre : 1.0F;
  match.normal_y = from_centre > 0.0F ? p.y / from_centre : 0.0F;
  return match;
}

/// The nearer of the straight line and, when it takes part, the circle.
LineMatch nearer(const Field& field, const FieldPoint& p, const LineMatch& straight, float best, bool circle) {
  const float radius = field.dimensions().circle_radius;
  if (radius <= 0.0F || !circle) return straight;
  const float from_centre = math::hypot(p.x, p.y);
  return math::square(from_centre - radius) < best ? on_circle(radius, p, from_centre) : straight;
}

}  // namespace

void DistanceField::build(const Field& field) {
  const auto nodes = [](float half) { return static_cast<int>((half + cap) / cell) + 2; };
  columns_ = nodes(0.5F * field.dimensions().length);
  rows_ = nodes(0.5F * field.dimensions().width);
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const FieldPoint p{static_cast<float>(x) * cell, static_cast<float>(y) * cell};
      const auto node = static_cast<std::size_t>(y * columns_ + x);
      layers_[0][node] = quantised(exact_distance(field, p, LineAxis::x));
      layers_[1][node] = quantised(exact_distance(field, p, LineAxis::y));
    }
  }
}

float DistanceField::distance(const FieldPoint& p, LineAxis axis) const { return distance_inline(p, axis); }

LineMatch nearest_line(const Field& field, const FieldPoint& p, float dx, float dy) {
  const bool along_x = axis_of(dx, dy) == LineAxis::x;
  float best = 0.0F;
  const LineMatch straight = nearest_straight(field, p, along_x, !along_x, best);
  // The tangent (-p.y, p.x) is within 45 degrees of the direction: its part along is not less than its part across.
  const float along = math::abs(p.x * dy - p.y * dx);
  const float across = math::abs(p.x * dx + p.y * dy);
  return nearer(field, p, straight, best, along >= across);
}

LineMatch nearest_line(const Field& field, const FieldPoint& p, float direction) {
  const auto [s, c] = math::sin_cos(direction);
  return nearest_line(field, p, c, s);
}

LineMatch nearest_line(const Field& field, const FieldPoint& p) {
  float best = 0.0F;
  const LineMatch straight = nearest_straight(field, p, true, true, best);
  return nearer(field, p, straight, best, true);
}

}  // namespace touchline
