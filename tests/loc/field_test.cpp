// SPDX-License-Identifier: Apache-2.0
// Presets, and landmarks against the lines that meet there, and against the positions that the rendered data sets give.
#include "loc/field.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <limits>
#include <string>

using namespace touchline;

namespace {

const std::initializer_list<const char*> presets = {"acyut-5x3", "kidsize-9x6", "small-2026", "middle-2026"};

Field make(const char* name) {
  Field field;
  const auto dimensions = field_preset(name);
  REQUIRE(dimensions.has_value());
  REQUIRE(Field::create(*dimensions, field) == Status::ok);
  return field;
}

long count(const Field& field, JunctionType type) {
  const auto landmarks = field.landmarks();
  return std::count_if(landmarks.begin(), landmarks.end(), [type](const FieldLandmark& l) { return l.type == type; });
}

bool has(const Field& field, JunctionType type, float x, float y) {
  const auto landmarks = field.landmarks();
  return std::any_of(landmarks.begin(), landmarks.end(), [&](const FieldLandmark& l) {
    return l.type == type && math::hypot(l.at.x - x, l.at.y - y) < 1e-5F;
  });
}

/// Is there paint at the point? Segments and circle, between centres of lines.
bool on_line(const Field& field, float x, float y) {
  const float tolerance = 2e-3F;
  if (math::abs(math::hypot(x, y) - field.dimensions().circle_radius) < tolerance) return true;
  for (const FieldLine& line : field.lines()) {
    if (x < math::min(line.a.x, line.b.x) - tolerance || x > math::max(line.a.x, line.b.x) + tolerance) continue;
    if (y < math::min(line.a.y, line.b.y) - tolerance || y > math::max(line.a.y, line.b.y) + tolerance) continue;
    return true;  // all segments run along x or y
  }
  return false;
}

const char* refused(const FieldDimensions& d) {
  Field field;
  const char* what = "";
  CHECK(Field::create(d, field, &what) == Status::invalid_argument);
  CHECK(Field::create(d, field) == Status::invalid_argument);
  return what;
}

}  // namespace

TEST_CASE("each preset has the lines and landmarks that its areas ask for") {
  struct Expected {
    const char* name;
    std::size_t lines;
    long x, t, l;
  };
  for (const Expected& e : {Expected{"acyut-5x3", 11, 2, 6, 8}, Expected{"kidsize-9x6", 11, 2, 6, 8},
                            Expected{"small-2026", 17, 2, 10, 12}, Expected{"middle-2026", 17, 2, 10, 12}}) {
    CAPTURE(e.name);
    const Field field = make(e.name);
    CHECK(field.lines().size() == e.lines);
    CHECK(count(field, JunctionType::x) == e.x);
    CHECK(count(field, JunctionType::t) == e.t);
    CHECK(count(field, JunctionType::l) == e.l);
    CHECK(field.posts().size() == 4);
    CHECK(field.penalty_marks().size() == 2);
  }
  CHECK_FALSE(field_preset("no-such-field").has_value());
}

TEST_CASE("acyut-5x3 has its landmarks where the rendered data sets have them") {
  const Field field = make("acyut-5x3");
  for (const float sx : {-1.0F, 1.0F}) {
    for (const float sy : {-1.0F, 1.0F}) {
      CHECK(has(field, JunctionType::x, 0.0F, sy * 0.5F));
      CHECK(has(field, JunctionType::t, 0.0F, sy * 1.45F));
      CHECK(has(field, JunctionType::t, sx * 2.45F, sy * 0.9F));
      CHECK(has(field, JunctionType::l, sx * 2.05F, sy * 0.9F));
      CHECK(has(field, JunctionType::l, sx * 2.45F, sy * 1.45F));
    }
  }
  CHECK(field.posts()[0].x == doctest::Approx(-2.45));
  CHECK(field.posts()[0].y == doctest::Approx(0.6));
  CHECK(field.posts()[1].y == doctest::Approx(-0.6));
  CHECK(field.posts()[2].x == doctest::Approx(2.45));
  CHECK(field.penalty_marks()[0].x == doctest::Approx(-1.25));
  CHECK(field.penalty_marks()[1].x == doctest::Approx(1.25));
  CHECK(field.half_carpet_length() == doctest::Approx(3.1));
  CHECK(field.half_carpet_width() == doctest::Approx(2.1));
}

TEST_CASE("a branch runs along paint, and there is none in the other directions") {
  for (const char* name : presets) {
    CAPTURE(name);
    const Field field = make(name);
    for (const FieldLandmark& mark : field.landmarks()) {
      CAPTURE(mark.at.x);
      CAPTURE(mark.at.y);
      CHECK(mark.branches == (mark.type == JunctionType::l ? 2 : mark.type == JunctionType::t ? 3 : 4));
      for (int quarter = 0; quarter < 4; ++quarter) {
        const float direction = wrap_angle(static_cast<float>(quarter) * math::half_pi);
        bool is_branch = false;
        for (int i = 0; i < mark.branches; ++i) {
          if (math::abs(angle_difference(mark.direction[i], direction)) < 1e-3F) is_branch = true;
        }
        const float step = 0.04F;  // short enough for the circle to be straight
        CHECK(is_branch ==
              on_line(field, mark.at.x + step * math::cos(direction), mark.at.y + step * math::sin(direction)));
      }
    }
  }
}

TEST_CASE("branches are ordered as in a junction: L turns left, T begins with the stem, X goes round") {
  for (const char* name : presets) {
    const Field field = make(name);
    for (const FieldLandmark& mark : field.landmarks()) {
      const float quarter = angle_difference(mark.direction[1], mark.direction[0]);
      CHECK(quarter == doctest::Approx(static_cast<double>(math::half_pi)));
      if (mark.type == JunctionType::t) {
        CHECK(math::abs(angle_difference(mark.direction[2], mark.direction[0])) ==
              doctest::Approx(static_cast<double>(math::half_pi)));
        CHECK(math::abs(angle_difference(mark.direction[2], mark.direction[1])) ==
              doctest::Approx(static_cast<double>(math::pi)));
      }
      if (mark.type == JunctionType::x) {
        for (int i = 1; i < 4; ++i) {
          CHECK(angle_difference(mark.direction[i], mark.direction[i - 1]) ==
                doctest::Approx(static_cast<double>(math::half_pi)));
        }
      }
      for (int i = 0; i < mark.branches; ++i) {
        CHECK(mark.direction[i] > -math::pi);
        CHECK(mark.direction[i] <= math::pi);
      }
    }
  }
}

TEST_CASE("landmarks come in pairs, half a turn apart, and the field is its own mirror image in y") {
  for (const char* name : presets) {
    CAPTURE(name);
    const Field field = make(name);
    const auto marks = field.landmarks();
    REQUIRE(marks.size() % 2 == 0);
    for (std::size_t i = 0; i < marks.size(); i += 2) {
      CHECK(marks[i].type == marks[i + 1].type);
      CHECK(marks[i].at.x == -marks[i + 1].at.x);
      CHECK(marks[i].at.y == -marks[i + 1].at.y);
      for (int b = 0; b < marks[i].branches; ++b) {
        CHECK(math::abs(angle_difference(marks[i].direction[b], marks[i + 1].direction[b])) ==
              doctest::Approx(static_cast<double>(math::pi)));
      }
      CHECK(has(field, marks[i].type, marks[i].at.x, -marks[i].at.y));
    }
    for (const FieldLine& line : field.lines()) {
      CHECK(on_line(field, -line.a.x, line.a.y));
      CHECK(on_line(field, line.b.x, -line.b.y));
    }
  }
}

TEST_CASE("dimensions that cannot be are refused with the key's name") {
  const FieldDimensions good = *field_preset("small-2026");
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  struct Bad {
    float FieldDimensions::*key;
    const char* name;
    float too_large;
  };
  const Bad keys[] = {{&FieldDimensions::length, "length", 14.1F},
                      {&FieldDimensions::width, "width", 9.1F},
                      {&FieldDimensions::line_width, "line_width", 1.0F},
                      {&FieldDimensions::circle_radius, "circle_radius", 3.1F},
                      {&FieldDimensions::goal_area_depth, "goal_area_depth", 4.0F},
                      {&FieldDimensions::goal_area_width, "goal_area_width", 6.5F},
                      {&FieldDimensions::penalty_area_depth, "penalty_area_depth", 4.4F},
                      {&FieldDimensions::penalty_area_width, "penalty_area_width", 6.5F},
                      {&FieldDimensions::penalty_mark, "penalty_mark", 4.6F},
                      {&FieldDimensions::goal_width, "goal_width", 6.5F},
                      {&FieldDimensions::goal_height, "goal_height", 50.0F},
                      {&FieldDimensions::post_diameter, "post_diameter", 2.0F},
                      {&FieldDimensions::border, "border", 50.0F}};
  for (const Bad& bad : keys) {
    for (const float value : {not_a_number, -1.0F, bad.too_large, std::numeric_limits<float>::infinity()}) {
      FieldDimensions d = good;
      d.*bad.key = value;
      CHECK(std::string(refused(d)) == bad.name);
    }
  }
}

TEST_CASE("an area half given, or one that does not enclose the other, is refused") {
  FieldDimensions d = *field_preset("small-2026");
  d.goal_area_width = 0.0F;
  CHECK(std::string(refused(d)) == "goal_area_width");
  d = *field_preset("small-2026");
  d.penalty_area_depth = 0.9F;
  CHECK(std::string(refused(d)) == "penalty_area_depth");
  d = *field_preset("small-2026");
  d.penalty_area_width = 3.0F;
  CHECK(std::string(refused(d)) == "penalty_area_width");
}

TEST_CASE("a field without areas, circle and penalty marks is a field") {
  FieldDimensions d = *field_preset("small-2026");
  d.goal_area_depth = d.goal_area_width = d.penalty_area_depth = d.penalty_area_width = 0.0F;
  d.circle_radius = d.penalty_mark = 0.0F;
  Field field;
  REQUIRE(Field::create(d, field) == Status::ok);
  CHECK(field.lines().size() == 5);
  CHECK(field.landmarks().size() == 6);
  CHECK(field.penalty_marks().empty());
}

TEST_CASE("vision is told all that it has to know of the field") {
  FieldDimensions field;
  field.line_width = 0.11F;
  field.circle_radius = 0.51F;
  field.post_diameter = 0.13F;
  VisionConfig vision;
  tell_vision(field, vision);
  CHECK(vision.line_width_m == 0.11F);
  CHECK(vision.circle_radius_m == 0.51F);
  CHECK(vision.post_diameter_m == 0.13F);
}
