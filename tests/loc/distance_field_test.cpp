// SPDX-License-Identifier: Apache-2.0
// The table and the exact search, both against a plain walk over points drawn along every line.
#include "loc/distance_field.h"

#include <doctest/doctest.h>

#include <initializer_list>
#include <limits>
#include <memory>
#include <vector>

#include "platform/core/rng.h"

using namespace touchline;

namespace {

Field make(const char* name) {
  Field field;
  REQUIRE(Field::create(*field_preset(name), field) == Status::ok);
  return field;
}

struct Paint {
  FieldPoint at;
  float direction;
};

/// Every line as points 2 mm apart.
std::vector<Paint> painted(const Field& field) {
  std::vector<Paint> points;
  const auto add_line = [&](const FieldPoint& a, const FieldPoint& b) {
    const float length = math::hypot(b.x - a.x, b.y - a.y);
    const int n = static_cast<int>(length / 0.002F) + 1;
    for (int i = 0; i <= n; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(n);
      points.push_back({{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, math::atan2(b.y - a.y, b.x - a.x)});
    }
  };
  for (const FieldLine& line : field.lines()) add_line(line.a, line.b);
  const float r = field.dimensions().circle_radius;
  for (int i = 0; i < 5000; ++i) {
    const float phi = static_cast<float>(i) * math::two_pi / 5000.0F;
    points.push_back({{r * math::cos(phi), r * math::sin(phi)}, phi + math::half_pi});
  }
  return points;
}

/// Distance to the nearest painted point whose direction is within `tolerance` of `direction`.
float walked(const std::vector<Paint>& paint, const FieldPoint& p, float direction, float tolerance) {
  float best = 1e9F;
  for (const Paint& q : paint) {
    const float turn = math::abs(angle_difference(q.direction, direction));
    if (math::min(turn, math::pi - turn) > tolerance) continue;
    best = math::min(best, math::square(p.x - q.at.x) + math::square(p.y - q.at.y));
  }
  return math::sqrt(best);
}

FieldPoint random_point(Rng& rng, const Field& field) {
  const float x = field.half_carpet_length() + 0.3F;
  const float y = field.half_carpet_width() + 0.3F;
  return {rng.uniform(-x, x), rng.uniform(-y, y)};
}

}  // namespace

TEST_CASE("the nearest of all lines is as far as a walk over the paint says") {
  for (const char* name : {"acyut-5x3", "small-2026", "middle-2026"}) {
    CAPTURE(name);
    const Field field = make(name);
    const auto paint = painted(field);
    Rng rng(1);
    for (int i = 0; i < 60; ++i) {
      const FieldPoint p = random_point(rng, field);
      const LineMatch match = nearest_line(field, p);
      CHECK(math::abs(match.distance) == doctest::Approx(walked(paint, p, 0.0F, 10.0F)).epsilon(1e-3));
    }
  }
}

TEST_CASE("with a direction only lines that run that way count") {
  const Field field = make("small-2026");
  const auto paint = painted(field);
  Rng rng(2);
  for (int i = 0; i < 100; ++i) {
    const FieldPoint p = random_point(rng, field);
    const float direction = math::half_pi * static_cast<float>(rng.below(4)) + rng.uniform(-0.5F, 0.5F);
    const LineMatch match = nearest_line(field, p, direction);
    const float straight_and_circle = walked(paint, p, direction, radians(45.0F));
    // The circle answers with its nearest point alone; farther points of it may run that way too.
    CHECK(math::abs(match.distance) >= straight_and_circle - 2e-3F);
    if (match.line == LineMatch::circle) {
      CHECK(math::abs(match.distance) == doctest::Approx(straight_and_circle).epsilon(1e-3));
    }
    const LineMatch again = nearest_line(field, p, 3.0F * math::cos(direction), 3.0F * math::sin(direction));
    CHECK(again.line == match.line);
    CHECK(again.distance == doctest::Approx(match.distance).epsilon(1e-4));
  }
}

TEST_CASE("the point is the foot plus distance times normal, and the foot is on the line") {
  const Field field = make("middle-2026");
  Rng rng(3);
  for (int i = 0; i < 1000; ++i) {
    const FieldPoint p = random_point(rng, field);
    const LineMatch match = nearest_line(field, p, rng.uniform(-3.0F, 3.0F));
    CHECK(math::hypot(match.normal_x, match.normal_y) == doctest::Approx(1.0));
    const FieldPoint foot{p.x - match.distance * match.normal_x, p.y - match.distance * match.normal_y};
    CHECK(math::abs(nearest_line(field, foot).distance) < 2e-5F);
  }
}

TEST_CASE("by hand: beside, beyond and inside") {
  const Field field = make("acyut-5x3");
  const LineMatch touch = nearest_line(field, {1.0F, 1.35F}, 0.0F);
  CHECK(touch.distance == doctest::Approx(-0.1));
  CHECK(touch.normal_y == 1.0F);
  const LineMatch corner = nearest_line(field, {2.48F, 1.49F});
  CHECK(corner.distance == doctest::Approx(0.05));
  CHECK(corner.normal_x == doctest::Approx(0.6));
  CHECK(corner.normal_y == doctest::Approx(0.8));
  const LineMatch inside = nearest_line(field, {0.24F, 0.32F}, 0.64F - math::half_pi * 1.0F);
  CHECK(inside.line == LineMatch::circle);
  CHECK(inside.distance == doctest::Approx(-0.1));
  CHECK(inside.normal_x == doctest::Approx(0.6));
  // Along the radius it is not the circle.
  CHECK(nearest_line(field, {0.48F, 0.02F}, 0.0F).line >= 0);
  CHECK(nearest_line(field, {0.48F, 0.02F}, math::half_pi).line == LineMatch::circle);
  CHECK(nearest_line(field, {0.0F, 0.0F}).distance == 0.0F);  // the half line
}

TEST_CASE("the distance passes through zero with its sign where a line is crossed") {
  const Field field = make("small-2026");
  CHECK(nearest_line(field, {1.0F, 2.99F}, 0.0F).distance == doctest::Approx(-0.01).epsilon(1e-3));
  CHECK(nearest_line(field, {1.0F, 3.01F}, 0.0F).distance == doctest::Approx(0.01).epsilon(1e-3));
  CHECK(nearest_line(field, {0.0F, 0.74F}, 0.0F).distance == doctest::Approx(-0.01).epsilon(1e-3));
  CHECK(nearest_line(field, {0.0F, 0.76F}, 0.0F).distance == doctest::Approx(0.01).epsilon(1e-3));
}

TEST_CASE("the table agrees with the exact search within its stated error, in all four quarters") {
  for (const char* name : {"acyut-5x3", "kidsize-9x6", "small-2026", "middle-2026"}) {
    CAPTURE(name);
    const Field field = make(name);
    const auto table = std::make_unique<DistanceField>();
    table->build(field);
    Rng rng(4);
    double sum = 0.0;
    constexpr int n = 20000;
    float worst = 0.0F;
    for (int i = 0; i < n; ++i) {
      const FieldPoint p = random_point(rng, field);
      const float exact = math::min(math::abs(nearest_line(field, p).distance), DistanceField::cap);
      const float error = math::abs(table->distance(p) - exact);
      worst = math::max(worst, error);
      sum += static_cast<double>(error);
    }
    CHECK(worst < 0.5F * DistanceField::cell + DistanceField::unit);
    CHECK(sum / n < 0.002);
  }
}

TEST_CASE("each layer knows its own lines, and the circle where it runs that way") {
  const Field field = make("small-2026");
  const auto table = std::make_unique<DistanceField>();
  table->build(field);
  // Between the half line (x = 0) and nothing along x for a metre.
  CHECK(table->distance({0.0F, 1.9F}, LineAxis::y) == 0.0F);
  CHECK(table->distance({0.0F, 1.9F}, LineAxis::x) > 0.9F);
  // On the circle at 90, 45 and 0 degrees.
  CHECK(table->distance({0.0F, -0.75F}, LineAxis::x) < 0.026F);
  CHECK(table->distance({0.53F, 0.53F}, LineAxis::x) < 0.026F);
  CHECK(table->distance({-0.53F, 0.53F}, LineAxis::y) < 0.026F);
  CHECK(table->distance({-0.75F, 0.0F}, LineAxis::y) < 0.026F);
  CHECK(table->distance({-0.75F, 0.0F}, LineAxis::x) > 0.5F);
  CHECK(axis_of(-2.0F, 1.0F) == LineAxis::x);
  CHECK(axis_of(0.1F, -1.0F) == LineAxis::y);
}

TEST_CASE("far outside, not a number, and before build() the distance is the cap") {
  const auto table = std::make_unique<DistanceField>();
  CHECK(table->distance({0.0F, 0.0F}) == DistanceField::cap);
  const Field field = make("acyut-5x3");
  table->build(field);
  CHECK(table->distance({100.0F, 0.0F}) == DistanceField::cap);
  CHECK(table->distance({0.0F, -1e30F}) == DistanceField::cap);
  CHECK(table->distance({std::numeric_limits<float>::quiet_NaN(), 0.0F}) == DistanceField::cap);
  CHECK(table->distance({std::numeric_limits<float>::infinity(), 0.0F}) == DistanceField::cap);
}

TEST_CASE("the largest field fits") {
  FieldDimensions d = *field_preset("middle-2026");
  d.border = max_field_border;
  Field field;
  REQUIRE(Field::create(d, field) == Status::ok);
  const auto table = std::make_unique<DistanceField>();
  table->build(field);
  CHECK(table->distance({7.0F, 4.5F}) == 0.0F);
  CHECK(table->distance({7.5F, -4.0F}) == doctest::Approx(0.5));
  CHECK(sizeof(DistanceField) < 37U * 1024U);
}
