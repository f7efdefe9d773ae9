// SPDX-License-Identifier: Apache-2.0
// The opponent's half is written down; the own half is the same, turned by half a turn about the centre mark.
#include "loc/field.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float east = 0.0F, north = math::half_pi, west = math::pi, south = -math::half_pi;  // of the field's x and y

FieldPoint turned(const FieldPoint& p) { return {-p.x, -p.y}; }

/// Exact for the four directions above: pi comes back as 0.
float turned(float direction) { return direction > 0.0F ? direction - math::pi : direction + math::pi; }

bool within(float value, float low, float high) { return value >= low && value <= high; }

/// Depth and width of an area both 0, or both inside half a field.
const char* check_area(const FieldDimensions& d, float depth, float width, const char* depth_key,
                       const char* width_key) {
  if (depth == 0.0F && width == 0.0F) return nullptr;
  if (!(depth > 0.0F && depth < 0.5F * d.length - d.circle_radius)) return depth_key;
  if (!(width > 0.0F && width < d.width)) return width_key;
  return nullptr;
}

/// The first key that is out of range; null when all fit. NaN fails every comparison.
const char* wrong_key(const FieldDimensions& d) {
  if (!within(d.length, 1.0F, max_field_length)) return "length";
  if (!within(d.width, 1.0F, max_field_width)) return "width";
  if (!within(d.line_width, 0.01F, 0.3F)) return "line_width";
  if (!(d.circle_radius >= 0.0F && d.circle_radius < 0.5F * d.width && d.circle_radius < 0.5F * d.length)) {
    return "circle_radius";
  }
  const char* area = check_area(d, d.goal_area_depth, d.goal_area_width, "goal_area_depth", "goal_area_width");
  if (area != nullptr) return area;
  area = check_area(d, d.penalty_area_depth, d.penalty_area_width, "penalty_area_depth", "penalty_area_width");
  if (area != nullptr) return area;
  // One area lies inside the other: where their lines crossed there would be junctions that nobody knows of.
  if (d.penalty_area_depth > 0.0F && !(d.penalty_area_depth > d.goal_area_depth)) return "penalty_area_depth";
  if (d.penalty_area_width > 0.0F && !(d.penalty_area_width > d.goal_area_width)) return "penalty_area_width";
  if (!(d.penalty_mark >= 0.0F && d.penalty_mark < 0.5F * d.length)) return "penalty_mark";
  if (!(d.goal_width > 0.0F && d.goal_width < d.width)) return "goal_width";
  if (!within(d.goal_height, 0.1F, 5.0F)) return "goal_height";
  if (!within(d.post_diameter, 0.01F, 0.5F)) return "post_diameter";
  if (!within(d.border, 0.0F, max_field_border)) return "border";
  return nullptr;
}

}  // namespace

std::optional<FieldDimensions> field_preset(std::string_view name) {
  if (name == "acyut-5x3") {
    return FieldDimensions{4.90F, 2.90F, 0.10F, 0.50F, 0.40F, 1.80F, 0.0F, 0.0F, 1.20F, 1.20F, 1.00F, 0.10F, 0.65F};
  }
  if (name == "kidsize-9x6") {
    return FieldDimensions{9.0F, 6.0F, 0.05F, 0.75F, 1.0F, 5.0F, 0.0F, 0.0F, 2.10F, 2.60F, 1.80F, 0.10F, 0.70F};
  }
  if (name == "small-2026") {
    return FieldDimensions{9.0F, 6.0F, 0.05F, 0.75F, 1.0F, 3.0F, 2.0F, 4.0F, 1.50F, 1.80F, 1.20F, 0.10F, 1.0F};
  }
  if (name == "middle-2026") {
    return FieldDimensions{14.0F, 9.0F, 0.07F, 1.50F, 1.0F, 4.0F, 3.0F, 6.0F, 2.10F, 2.60F, 1.80F, 0.10F, 1.0F};
  }
  return std::nullopt;
}

void tell_vision(const FieldDimensions& field, VisionConfig& vision) {
  vision.line_width_m = field.line_width;
  vision.circle_radius_m = field.circle_radius;
  vision.post_diameter_m = field.post_diameter;
}

Status Field::create(const FieldDimensions& dimensions, Field& out, const char** what) {
  const char* wrong = wrong_key(dimensions);
  if (wrong != nullptr) {
    if (what != nullptr) *what = wrong;
    return Status::invalid_argument;
  }
  Field field;
  field.dimensions_ = dimensions;
  field.add_lines();
  field.sort_by_axis();
  field.add_landmarks();
  out = field;
  return Status::ok;
}

void Field::sort_by_axis() {
  std::size_t sorted = 0;
  for (const bool wanted : {true, false}) {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const FieldLine& line = lines_[i];
      const bool is_x = line.a.y == line.b.y;
      if (is_x != wanted) continue;
      AxisLine& to = by_axis_[sorted++];
      to.low = is_x ? math::min(line.a.x, line.b.x) : math::min(line.a.y, line.b.y);
      to.high = is_x ? math::max(line.a.x, line.b.x) : math::max(line.a.y, line.b.y);
      to.across = is_x ? line.a.y : line.a.x;
      to.index = static_cast<int>(i);
    }
    if (wanted) along_x_ = sorted;
  }
}

void Field::add_lines() {
  const float x = 0.5F * dimensions_.length;
  const float y = 0.5F * dimensions_.width;
  lines_.push_back({{-x, y}, {x, y}});
  lines_.push_back({{-x, -y}, {x, -y}});
  lines_.push_back({{x, -y}, {x, y}});
  lines_.push_back({{-x, -y}, {-x, y}});
  lines_.push_back({{0.0F, -y}, {0.0F, y}});
  add_area(dimensions_.goal_area_depth, dimensions_.goal_area_width);
  add_area(dimensions_.penalty_area_depth, dimensions_.penalty_area_width);
  const float post = 0.5F * dimensions_.goal_width;
  for (const FieldPoint& p : {FieldPoint{-x, post}, FieldPoint{-x, -post}, FieldPoint{x, post}, FieldPoint{x, -post}}) {
    posts_.push_back(p);
  }
  if (dimensions_.penalty_mark > 0.0F) {
    penalty_marks_.push_back({-x + dimensions_.penalty_mark, 0.0F});
    penalty_marks_.push_back({x - dimensions_.penalty_mark, 0.0F});
  }
}

void Field::add_area(float depth, float width) {
  if (depth == 0.0F) return;
  const float goal_line = 0.5F * dimensions_.length;
  const float front = goal_line - depth;
  const float side = 0.5F * width;
  for (const FieldLine& line : {FieldLine{{goal_line, side}, {front, side}}, FieldLine{{front, side}, {front, -side}},
                                FieldLine{{front, -side}, {goal_line, -side}}}) {
    lines_.push_back(line);
    lines_.push_back({turned(line.a), turned(line.b)});
  }
  add_pair(JunctionType::t, {goal_line, side}, {west, south, north});
  add_pair(JunctionType::t, {goal_line, -side}, {west, south, north});
  add_pair(JunctionType::l, {front, side}, {south, east});
  add_pair(JunctionType::l, {front, -side}, {east, north});
}

void Field::add_landmarks() {
  const float x = 0.5F * dimensions_.length;
  const float y = 0.5F * dimensions_.width;
  // The circle crosses the half line with its tangent along x.
  if (dimensions_.circle_radius > 0.0F) {
    add_pair(JunctionType::x, {0.0F, dimensions_.circle_radius}, {east, north, west, south});
  }
  add_pair(JunctionType::t, {0.0F, y}, {south, east, west});
  add_pair(JunctionType::l, {x, y}, {west, south});
  add_pair(JunctionType::l, {x, -y}, {north, west});
}

void Field::add_pair(JunctionType type, const FieldPoint& at, std::initializer_list<float> directions) {
  FieldLandmark landmark;
  landmark.type = type;
  landmark.at = at;
  for (const float direction : directions) landmark.direction[landmark.branches++] = direction;
  landmarks_.push_back(landmark);
  landmark.at = turned(at);
  for (int i = 0; i < landmark.branches; ++i) landmark.direction[i] = turned(landmark.direction[i]);
  landmarks_.push_back(landmark);
}

}  // namespace touchline
