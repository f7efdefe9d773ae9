// SPDX-License-Identifier: Apache-2.0
#include "loc/distance_field.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float far_away = 1.0e9F;  // square metres; more than any distance on a field

/// All lines of a field run along x or y, so the nearest point of one is a clamped coordinate. A point by its
/// coordinates along the line and across it.
struct AxisPoint {
  float along, across;
};
AxisPoint in_x(const FieldPoint& p) { return {p.x, p.y}; }
AxisPoint in_y(const FieldPoint& p) { return {p.y, p.x}; }

/// The nearest line so far, and its point.
struct Nearest {
  const AxisLine* line = nullptr;
  float squared = far_away;
  float along = 0.0F;
};

/// Strictly nearer lines alone replace one.
void look_for_nearer(std::span<const AxisLine> lines, const AxisPoint& p, Nearest& best) {
  for (const AxisLine& line : lines) {
    const float across = math::square(p.across - line.across);
    if (across >= best.squared) continue;  // whatever is added along the line
    const float along = math::clamp(p.along, line.low, line.high);
    const float squared = math::square(p.along - along) + across;
    if (squared < best.squared) best = {&line, squared, along};
  }
}

/// Is the circle's tangent near p within 67.5 degrees of the axis? The radius stands at right angles to it.
bool circle_counts(const FieldPoint& p, LineAxis axis) {
  constexpr float tan_67_5 = 2.41421356F;
  const float across = axis == LineAxis::x ? math::abs(p.y) : math::abs(p.x);
  const float along = axis == LineAxis::x ? math::abs(p.x) : math::abs(p.y);
  return along <= tan_67_5 * across;
}

float exact_distance(const Field& field, const FieldPoint& p, LineAxis axis) {
  Nearest nearest;
  if (axis == LineAxis::x) {
    look_for_nearer(field.lines_along_x(), in_x(p), nearest);
  } else {
    look_for_nearer(field.lines_along_y(), in_y(p), nearest);
  }
  float best = nearest.squared;
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

/// Beside the line the normal is the axis, so that the distance passes smoothly through zero. Beyond its end the normal
/// points from the end to the point. `along` and `across`: where the match keeps its normal.
void match_with(const Nearest& nearest, const AxisPoint& p, float& along, float& across, LineMatch& match) {
  const float beyond = p.along - nearest.along;
  if (beyond == 0.0F) {
    along = 0.0F;
    across = 1.0F;
    match.distance = p.across - nearest.line->across;
  } else {
    match.distance = math::sqrt(nearest.squared);
    along = beyond / match.distance;
    across = (p.across - nearest.line->across) / match.distance;
  }
}

/// Lines along x and along y, where they take part; of two that are equally near the first of the field.
LineMatch nearest_straight(const Field& field, const FieldPoint& p, bool use_x, bool use_y, float& best) {
  Nearest x, y;
  if (use_x) look_for_nearer(field.lines_along_x(), in_x(p), x);
  if (use_y) look_for_nearer(field.lines_along_y(), in_y(p), y);
  const bool first_x = y.line == nullptr || (x.line != nullptr && x.line->index < y.line->index);
  const bool is_x = x.line != nullptr && (first_x ? x.squared <= y.squared : x.squared < y.squared);
  const Nearest& nearest = is_x ? x : y;
  best = nearest.squared;
  LineMatch match;
  if (nearest.line == nullptr) return match;
  match.line = nearest.line->index;
  if (is_x) {
    match_with(nearest, in_x(p), match.normal_x, match.normal_y, match);
  } else {
    match_with(nearest, in_y(p), match.normal_y, match.normal_x, match);
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
  last_column_ = static_cast<float>(columns_ - 1);
  last_row_ = static_cast<float>(rows_ - 1);
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      const FieldPoint p{static_cast<float>(x) * cell, static_cast<float>(y) * cell};
      const auto node = static_cast<std::size_t>(y * columns_ + x);
      nodes_[node] = quantised(exact_distance(field, p, LineAxis::x));
      nodes_[node + layer] = quantised(exact_distance(field, p, LineAxis::y));
    }
  }
}

DistanceCells DistanceField::cells() const {
  return {nodes_.data(), columns_, layer, last_column_, last_row_, 1.0F / cell};
}

float DistanceField::distance(const FieldPoint& p, LineAxis axis) const {
  constexpr float per_metre = 1.0F / cell;
  const float u = math::abs(p.x) * per_metre;
  const float v = math::abs(p.y) * per_metre;
  if (!(u < last_column_ && v < last_row_)) return cap;
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const float right = u - static_cast<float>(column);
  const float down = v - static_cast<float>(row);
  const std::uint8_t* node = nodes_.data() + (axis == LineAxis::x ? 0 : layer) + (row * columns_ + column);
  const float a = static_cast<float>(node[0]);
  const float b = static_cast<float>(node[1]);
  const float c = static_cast<float>(node[columns_]);
  const float d = static_cast<float>(node[columns_ + 1]);
  const float top = a + right * (b - a);
  const float bottom = c + right * (d - c);
  return unit * (top + down * (bottom - top));
}

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
