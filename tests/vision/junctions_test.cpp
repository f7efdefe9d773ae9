// SPDX-License-Identifier: Apache-2.0
#include "vision/junctions.h"

#include <doctest/doctest.h>

#include "tests/vision/drawn_ground.h"

namespace touchline {
namespace {

using test::Scene;
using test::Seen;

constexpr float close_px = 4.0F;  // camera pixels: what counts as found

float off(float direction, float degrees_expected) {
  return math::abs(angle_difference(direction, radians(degrees_expected)));
}

/// Takes the carpet away where `hidden` says so, as an obstacle would, and judges the junctions again, with the centre
/// circle where its radius is given.
template <typename Hidden>
void hide(Seen& seen, Hidden hidden, float circle_radius = 0.0F) {
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      GroundPoint p;
      const WorkPoint w{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
      if (seen.projection.ground(seen.rays->camera_pixel(w), p) && hidden(p)) seen.carpet.view().set(x, y, false);
    }
  }
  seen.features->junctions.clear();
  seen.features->rejections.clear();
  const SeenCircle circle{seen.features->circle, seen.circle_work.seen, circle_radius};
  (void)find_junctions(*seen.lines, circle_radius > 0.0F ? &circle : nullptr, *seen.rays,
                       {seen.mask.view(), seen.carpet.view(), seen.carpet.view(), {}}, {0.10F, 6.0F},
                       *seen.junction_work, *seen.features);
}

}  // namespace

TEST_CASE("an L at a range of distances: one junction, place, order and directions of branches") {
  for (const float x : {0.6F, 1.0F, 1.5F, 2.0F}) {
    CAPTURE(x);
    Scene scene;
    scene.lines = {{{x, 0.2F}, {x, 1.5F}}, {{x, 0.2F}, {x + 1.5F, 0.2F}}};
    const Seen seen(scene);
    REQUIRE(seen.features->junctions.size() == 1);
    const Junction* l = seen.nearest(JunctionType::l, {x, 0.2F});
    REQUIRE(l != nullptr);
    CHECK(seen.pixels_off(*l, {x, 0.2F}) < close_px);
    CHECK(l->branches == 2);
    CHECK(off(l->direction[0], 0.0F) < radians(8.0F));
    CHECK(off(l->direction[1], 90.0F) < radians(8.0F));
    CHECK(l->confidence > 0.1F);
    CHECK(l->confidence <= 1.0F);
    CHECK(l->covariance.xx > 0.0F);
  }
}

TEST_CASE("a T: the stem comes first, then the bar counter-clockwise of it") {
  Scene scene;
  scene.lines = {{{1.5F, -1.5F}, {1.5F, 1.5F}}, {{0.5F, 0.1F}, {1.5F, 0.1F}}};
  const Seen seen(scene);
  REQUIRE(seen.features->junctions.size() == 1);
  const Junction* t = seen.nearest(JunctionType::t, {1.5F, 0.1F});
  REQUIRE(t != nullptr);
  CHECK(seen.pixels_off(*t, {1.5F, 0.1F}) < close_px);
  CHECK(t->branches == 3);
  CHECK(off(t->direction[0], 180.0F) < radians(6.0F));
  CHECK(off(t->direction[1], 270.0F) < radians(6.0F));
  CHECK(off(t->direction[2], 90.0F) < radians(6.0F));
}

TEST_CASE("the goal area of a small field: a stem of 0.40 m between a T and an L, lines 0.10 m wide") {
  Scene scene;
  scene.lines = {{{1.2F, -1.5F}, {1.2F, 1.5F}}, {{0.8F, 0.5F}, {1.2F, 0.5F}}, {{0.8F, 0.5F}, {0.8F, -1.3F}}};
  const Seen seen(scene);
  const Junction* t = seen.nearest(JunctionType::t, {1.2F, 0.5F});
  const Junction* l = seen.nearest(JunctionType::l, {0.8F, 0.5F});
  REQUIRE(t != nullptr);
  REQUIRE(l != nullptr);
  CHECK(seen.pixels_off(*t, {1.2F, 0.5F}) < close_px);
  CHECK(seen.pixels_off(*l, {0.8F, 0.5F}) < close_px);
  CHECK(seen.features->junctions.size() == 2);
}

TEST_CASE("an X of two straight lines") {
  Scene scene;
  scene.lines = {{{1.2F, -1.5F}, {1.2F, 1.5F}}, {{0.4F, 0.1F}, {2.5F, 0.1F}}};
  const Seen seen(scene);
  REQUIRE(seen.features->junctions.size() == 1);
  const Junction* x = seen.nearest(JunctionType::x, {1.2F, 0.1F});
  REQUIRE(x != nullptr);
  CHECK(x->branches == 4);
  CHECK(seen.pixels_off(*x, {1.2F, 0.1F}) < close_px);
  for (int i = 0; i < 4; ++i) {
    const float turn =
        wrap_angle(x->direction[static_cast<std::size_t>((i + 1) % 4)] - x->direction[static_cast<std::size_t>(i)]);
    CHECK(math::abs(turn - math::half_pi) < radians(10.0F));
  }
}

TEST_CASE("roll and pitch of the camera change nothing on the ground") {
  for (const float roll : {-20.0F, 20.0F, 90.0F}) {
    CAPTURE(roll);
    Scene scene;
    scene.roll_deg = roll;
    scene.lines = {{{1.0F, -1.2F}, {1.0F, 1.2F}}, {{0.3F, 0.0F}, {1.0F, 0.0F}}};
    const Seen seen(scene);
    const Junction* t = seen.nearest(JunctionType::t, {1.0F, 0.0F});
    REQUIRE(t != nullptr);
    CHECK(seen.pixels_off(*t, {1.0F, 0.0F}) < close_px);
  }
}

TEST_CASE("no junctions: a long line that the lens bends, and a penalty mark") {
  Scene scene;
  scene.lines = {{{0.8F, -3.0F}, {0.8F, 3.0F}}, {{1.5F, -0.1F}, {1.5F, 0.1F}}, {{1.4F, 0.0F}, {1.6F, 0.0F}}};
  const Seen seen(scene);
  CHECK(seen.features->junctions.empty());
}

TEST_CASE("lines that meet at 50 degrees are no lines of a field") {
  Scene scene;
  scene.lines = {{{1.0F, 0.0F}, {1.0F, 1.5F}}, {{1.0F, 0.0F}, {2.2F, 1.0F}}};
  const Seen seen(scene);
  CHECK(seen.features->junctions.empty());
  CHECK((seen.rejected(JunctionRejection::bad_angles, {1.0F, 0.0F}) ||
         seen.rejected(JunctionRejection::curved, {1.0F, 0.0F})));
}

TEST_CASE("where the carpet beyond is hidden, a corner has no type") {
  Scene scene;
  scene.lines = {{{1.0F, 0.2F}, {1.0F, 1.5F}}, {{1.0F, 0.2F}, {2.5F, 0.2F}}};
  Seen seen(scene);
  REQUIRE(seen.count(JunctionType::l) == 1);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {  // an obstacle from 0.08 m to the right of the corner on
      GroundPoint p;
      const WorkPoint w{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
      if (seen.projection.ground(seen.rays->camera_pixel(w), p) && p.y < 0.12F) seen.carpet.view().set(x, y, false);
    }
  }
  seen.features->junctions.clear();
  seen.features->rejections.clear();
  (void)find_junctions(*seen.lines, nullptr, *seen.rays, {seen.mask.view(), seen.carpet.view(), seen.carpet.view(), {}},
                       {0.10F, 6.0F}, *seen.junction_work, *seen.features);
  CHECK(seen.features->junctions.empty());
  CHECK(seen.rejected(JunctionRejection::at_border, {1.0F, 0.2F}));
}

TEST_CASE(
    "a corner at the robot's feet, a branch of it cut off by the picture's edge after little more than its width") {
  Scene scene;
  const GroundPoint corner{0.16F, 0.1F};  // the picture ends 0.01 m ahead: a line's width of the branch is seen
  scene.lines = {{corner, {corner.x, -1.2F}}, {corner, {-0.3F, corner.y}}};
  const Seen seen(scene);
  const Junction* l = seen.nearest(JunctionType::l, corner);
  REQUIRE(l != nullptr);
  CHECK(seen.pixels_off(*l, corner) < 2.0F * close_px);
}

TEST_CASE("junctions beyond the range are turned down") {
  Scene scene;
  scene.lines = {{{1.5F, -1.5F}, {1.5F, 1.5F}}, {{0.5F, 0.1F}, {1.5F, 0.1F}}};
  Seen seen(scene);
  seen.features->junctions.clear();
  seen.features->rejections.clear();
  (void)find_junctions(*seen.lines, nullptr, *seen.rays, {seen.mask.view(), seen.carpet.view(), seen.carpet.view(), {}},
                       {0.10F, 1.2F}, *seen.junction_work, *seen.features);
  CHECK(seen.features->junctions.empty());
  CHECK(seen.rejected(JunctionRejection::too_far, {1.5F, 0.1F}));
}

TEST_CASE("a bridge between two lines, a T at both ends, is dirt and no line") {
  Scene scene;
  scene.lines = {{{1.0F, -1.5F}, {1.0F, 1.5F}}, {{1.45F, -1.5F}, {1.45F, 1.5F}}, {{1.0F, 0.2F}, {1.45F, 0.2F}}};
  const Seen seen(scene);
  CHECK(seen.features->junctions.empty());
  CHECK(seen.rejected(JunctionRejection::bridge, {1.0F, 0.2F}));
}

TEST_CASE("a white foot that stands on a line is no stem: no carpet beside it") {
  Scene scene;
  scene.lines = {{{1.2F, -1.5F}, {1.2F, 1.5F}}, {{0.9F, 0.1F}, {1.2F, 0.1F}}};
  Seen seen(scene);
  REQUIRE(seen.count(JunctionType::t) == 1);
  hide(seen, [](const GroundPoint& p) { return p.x > 0.75F && p.x < 1.1F && math::abs(p.y - 0.1F) < 0.25F; });
  CHECK(seen.features->junctions.empty());
}

TEST_CASE("a T whose far side is hidden is a T: straight lines of a field never cross") {
  Scene scene;
  scene.lines = {{{1.2F, -1.5F}, {1.2F, 1.5F}}, {{0.5F, 0.1F}, {1.2F, 0.1F}}};
  Seen seen(scene);
  hide(seen, [](const GroundPoint& p) { return p.x > 1.32F; });
  CHECK(seen.count(JunctionType::t) == 1);
}

TEST_CASE("a line behind a post goes on: the T beside it has its bar") {
  Scene scene;
  scene.lines = {{{1.2F, -1.5F}, {1.2F, -0.35F}}, {{1.2F, -0.05F}, {1.2F, 1.5F}}, {{0.5F, 0.1F}, {1.2F, 0.1F}}};
  Seen seen(scene);
  hide(seen, [](const GroundPoint& p) { return p.x > 1.1F && p.y > -0.35F && p.y < 0.0F; });
  const Junction* t = seen.nearest(JunctionType::t, {1.2F, 0.1F});
  REQUIRE(t != nullptr);
  CHECK(seen.pixels_off(*t, {1.2F, 0.1F}) < close_px);
}

TEST_CASE("the half line ends in a T, also where half of the bar is hidden; another line's end does not") {
  Scene scene;
  scene.circles = {{{1.2F, 0.0F}, 0.5F}};
  scene.lines = {{{1.2F, -1.4F}, {1.2F, 1.4F}}, {{0.3F, 1.4F}, {1.25F, 1.4F}}};
  const auto behind_robot = [](const GroundPoint& p) { return p.x > 1.26F && p.y > 1.1F; };
  Seen seen(scene, 0.5F);
  REQUIRE(seen.features->has_circle);
  REQUIRE(seen.features->circle.has_half_line);
  hide(seen, behind_robot, 0.5F);
  const Junction* t = seen.nearest(JunctionType::t, {1.2F, 1.4F});
  REQUIRE(t != nullptr);
  CHECK(seen.pixels_off(*t, {1.2F, 1.4F}) < close_px);
  CHECK(off(t->direction[0], 270.0F) < radians(8.0F));
  CHECK(off(t->direction[1], 0.0F) < radians(8.0F));
  hide(seen, behind_robot);  // with no circle it may be a corner as well
  CHECK(seen.nearest(JunctionType::t, {1.2F, 1.4F}) == nullptr);
  seen.features->circle.half_line_direction = 0.0F;  // nor is it the half line's end, when that runs elsewhere
  hide(seen, behind_robot, 0.5F);
  CHECK(seen.nearest(JunctionType::t, {1.2F, 1.4F}) == nullptr);
}

}  // namespace touchline
