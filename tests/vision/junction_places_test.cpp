// SPDX-License-Identifier: Apache-2.0
// Junctions beside their place, and points on the lines that they are made of.
#include "vision/junction_places.h"

#include <doctest/doctest.h>

#include <memory>

#include "tests/vision/line_picture.h"

using namespace touchline;

namespace {

constexpr float px_m = 0.01F;  // metres on the ground of a working pixel

struct View {
  View() : View(test::Scene{}) {}
  explicit View(const test::Scene& scene) : picture(scene, test::usual_pose()) {}

  test::LinePicture picture;
  GroundProjection projection{test::paper_lens(), test::usual_pose()};
  std::unique_ptr<Features> features = std::make_unique<Features>();

  /// Points every 2 cm from `from` metres to `to` metres from `start` in a direction.
  void add_points(const GroundPoint& start, float direction, float from, float to) const {
    for (float t = from; t < to; t += 0.02F) {
      LinePoint p;
      p.ground = {start.x + t * math::cos(direction), start.y + t * math::sin(direction)};
      p.dir_x = math::cos(direction);
      p.dir_y = math::sin(direction);
      p.sigma = px_m;
      features->line_points.push_back(p);
    }
  }
  void add_junction(JunctionType type, const GroundPoint& at, float first, int branches) const {
    Junction j;
    j.type = type;
    j.ground = at;
    REQUIRE(projection.pixel(at, j.pixel));
    j.branches = branches;
    for (int i = 0; i < branches; ++i)
      j.direction[static_cast<std::size_t>(i)] = wrap_angle(first + static_cast<float>(i) * math::half_pi);
    features->junctions.push_back(j);
  }
  Junction placed() {
    place_junctions(picture.input(0.05F), *features);
    return features->junctions[0];
  }
};

constexpr GroundPoint corner{1.0F, 0.3F};
constexpr float turned = 0.4F;  // of the corner's first branch

}  // namespace

TEST_CASE("a corner moves to where the points on its lines cross, and its pixel moves along") {
  View view;
  view.add_points(corner, turned, 0.0F, 0.5F);
  view.add_points(corner, turned + math::half_pi, 0.0F, 0.5F);
  view.add_junction(JunctionType::l, {corner.x + 0.012F, corner.y - 0.015F}, turned, 2);
  const Junction j = view.placed();
  CHECK(math::hypot(j.ground.x - corner.x, j.ground.y - corner.y) < 0.002F);
  PixelPoint truth;
  REQUIRE(view.projection.pixel(corner, truth));
  CHECK(math::hypot(j.pixel.u - truth.u, j.pixel.v - truth.v) < 0.5F);
  CHECK(j.covariance.xx > 0.0F);
}

TEST_CASE("points on one line move a junction across that line alone") {
  View view;
  view.add_points({1.0F, 0.0F}, 0.0F, 0.0F, 0.5F);  // straight ahead: what a pixel means there is no tilted ellipse
  view.add_junction(JunctionType::l, {1.012F, -0.015F}, 0.0F, 2);
  const Junction j = view.placed();
  CHECK(math::abs(j.ground.y) < 0.002F);
  CHECK(math::abs(j.ground.x - 1.012F) < 0.002F);
}

TEST_CASE("lines beside, lines across and lines far away say nothing of a junction") {
  View view;
  const GroundPoint beside{corner.x, corner.y + 0.08F};  // of a goal area of a small field; eight working pixels
  view.add_points(beside, 0.0F, 0.0F, 0.5F);
  view.add_points({corner.x + 0.2F, corner.y - 0.2F}, math::half_pi, 0.0F, 0.4F);  // crosses the first branch
  view.add_points({corner.x, corner.y + 0.01F}, 0.0F, 0.7F, 1.5F);                 // goes on, but a little beside
  view.add_junction(JunctionType::t, corner, 0.0F, 3);
  const Junction j = view.placed();
  CHECK(math::hypot(j.ground.x - corner.x, j.ground.y - corner.y) < 0.001F);
}

TEST_CASE("the bent skeleton beside the crossing itself has no say") {
  View view;
  view.add_points({corner.x, corner.y + 0.02F}, 0.0F, 0.0F, 0.04F);
  view.add_junction(JunctionType::l, corner, 0.0F, 2);
  CHECK(view.placed().ground.y == doctest::Approx(corner.y).epsilon(1e-5));
}

TEST_CASE("an X stays where the centre circle's fit has put it") {
  View view;
  view.add_points({corner.x, corner.y + 0.015F}, 0.0F, 0.0F, 0.5F);
  view.add_junction(JunctionType::x, corner, 0.0F, 4);
  CHECK(view.placed().ground.y == corner.y);
}

TEST_CASE("a branch too short for line points is found in the picture") {
  test::Scene scene;
  scene.stripes = {{corner, {1.5F, corner.y}, 0.05F, test::line_white},  // to the middle of the lines
                   {{1.0F, corner.y - 0.025F}, {1.0F, corner.y + 0.12F}, 0.05F, test::line_white}};
  View view(scene);
  view.add_points(corner, 0.0F, 0.1F, 0.5F);  // of the first branch alone
  view.add_junction(JunctionType::l, {corner.x + 0.015F, corner.y - 0.01F}, 0.0F, 2);
  const Junction j = view.placed();
  CHECK(math::abs(j.ground.x - corner.x) < 0.005F);
  CHECK(math::abs(j.ground.y - corner.y) < 0.003F);
}
