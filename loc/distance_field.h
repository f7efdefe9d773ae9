// SPDX-License-Identifier: Apache-2.0
// How far a point is from the field's lines: looked up, for many particles times many points (the likelihood field of
// Thrun, Burgard, Fox, "Probabilistic Robotics", section 6.4), and exact, for the refinement of one pose.
// Distances are to the centres of lines, centre circle included; penalty marks are no lines.
#pragma once

#include <array>
#include <cstdint>

#include "loc/field.h"
#include "platform/core/elementary.h"
#include "platform/core/geometry.h"

namespace touchline {

/// Directions on a field are along x, along y, or on the circle anything between.
enum class LineAxis : std::uint8_t { x, y };

/// The axis that a direction vector (of any length) is nearer to.
inline LineAxis axis_of(float dx, float dy) { return math::abs(dx) >= math::abs(dy) ? LineAxis::x : LineAxis::y; }

/// The nodes of a DistanceField, row by row, in its own memory.
struct DistanceCells {
  const std::uint8_t* nodes = nullptr;  // lines along x, then lines along y; four bytes may be read from each
  int columns = 0;
  int layer = 0;                              // from a node for lines along x to the one for lines along y
  float last_column = 0.0F, last_row = 0.0F;  // there the distance has reached its cap
  float nodes_a_metre = 0.0F;
};

/// Distances in a quarter of the field (the rest is its mirror image in x and y), a layer for lines along x and one for
/// lines along y. The circle counts in a layer where its tangent is within 67.5 degrees of that axis, so that a
/// direction measured on it finds it in the layer that axis_of() names, also when it is off by 22.5 degrees.
class DistanceField {
 public:
  static constexpr float cell = 0.05F;          // metres; half the dimensions of the known fields are multiples of it
  static constexpr float unit = 1.0F / 256.0F;  // metres a step
  static constexpr float cap = 255.0F * unit;   // 0.996 m: what is farther is no line point of this line

  void build(const Field& field);

  /// Distance to the nearest line of that axis, at most `cap`; NaN gives `cap`. Interpolated between the four nodes
  /// around. Error: half a unit where the distance is linear, and up to half a cell (25 mm) too much (too little) where
  /// its slope jumps inside a cell: on a line that lies between nodes (half-way between two lines).
  [[nodiscard]] float distance(const FieldPoint& p, LineAxis axis) const;
  /// The nodes, for loops over many poses and samples, which take the nearest node: its error, half a cell on either
  /// axis at the most, is small beside what keeps particles apart.
  [[nodiscard]] DistanceCells cells() const;
  /// Distance to the nearest line of either.
  [[nodiscard]] float distance(const FieldPoint& p) const {
    return math::min(distance(p, LineAxis::x), distance(p, LineAxis::y));
  }

 private:
  // Half of the largest field, 1 m beyond (there the distance reaches `cap`), and a node at either end.
  static constexpr int max_columns = 161;
  static constexpr int max_rows = 111;
  static_assert((static_cast<float>(max_columns) - 1.0F) * cell >= 0.5F * max_field_length + cap);
  static_assert((static_cast<float>(max_rows) - 1.0F) * cell >= 0.5F * max_field_width + cap);
  static constexpr int layer = max_columns * max_rows;

  int columns_ = 0;  // in use; 0 before build(): then every distance is `cap`
  int rows_ = 0;
  float last_column_ = -1.0F;
  float last_row_ = -1.0F;
  // For lines along x, for lines along y, and what a kernel may read behind them.
  std::array<std::uint8_t, 2 * static_cast<std::size_t>(layer) + 4> nodes_{};
};

/// The line nearest to a point: the point is `nearest + distance * normal`.
struct LineMatch {
  float distance = 0.0F;  // signed, metres; never negative beyond a line's end, and outside the circle positive
  float normal_x = 0.0F;  // unit vector, field frame
  float normal_y = 0.0F;
  int line = -1;  // index in Field::lines(), or `circle`
  static constexpr int circle = -1;
};

/// Among lines that run within 45 degrees of `direction` (radians, field frame; of the circle: its tangent nearest to
/// the point). Exact. Always finds one on a valid field.
LineMatch nearest_line(const Field& field, const FieldPoint& p, float direction);
/// The same for a direction vector of any length.
LineMatch nearest_line(const Field& field, const FieldPoint& p, float dx, float dy);
/// Among all lines.
LineMatch nearest_line(const Field& field, const FieldPoint& p);

}  // namespace touchline
