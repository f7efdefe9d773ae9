// SPDX-License-Identifier: Apache-2.0
// A walk is one a humanoid can walk; falls, lifts and kidnaps do what they say.
#include "platform/host/sim/world.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

constexpr float dt = 1.0F / 12.0F;

WalkOptions options(std::uint64_t seed) {
  WalkOptions o;
  o.field = small_field();
  o.seed = seed;
  return o;
}

}  // namespace

TEST_CASE("world: five minutes of walking stay on the field, at a humanoid's speed, with all activities") {
  SimWorld world(options(3));
  double way = 0.0;
  int seen[5] = {};
  for (int i = 0; i < 3600; ++i) {
    const Pose2 before = world.state().pose;
    world.step(dt);
    const WorldState& s = world.state();
    CHECK(std::abs(s.pose.x) < 2.45F);
    CHECK(std::abs(s.pose.y) < 1.45F);
    CHECK(std::hypot(s.step.x, s.step.y) < 0.05F);
    CHECK(std::abs(s.step.theta) < 0.06F);
    const Pose2 after = compose(before, s.step);
    CHECK(after.x == doctest::Approx(s.pose.x));
    CHECK(after.theta == doctest::Approx(s.pose.theta));
    way += static_cast<double>(std::hypot(s.step.x, s.step.y));
    seen[static_cast<int>(s.activity)] += 1;
  }
  CHECK(way > 15.0);
  CHECK(seen[static_cast<int>(Activity::walking)] > 1000);
  CHECK(seen[static_cast<int>(Activity::halted)] > 10);
  CHECK(seen[static_cast<int>(Activity::turning)] > 10);
}

TEST_CASE("world: the head sways with the steps and is still at a halt") {
  WalkOptions o = options(4);
  SimWorld world(o);
  float lowest = 10.0F;
  float highest = -10.0F;
  for (int i = 0; i < 600; ++i) {
    world.step(dt);
    lowest = std::min(lowest, world.state().camera.pitch);
    highest = std::max(highest, world.state().camera.pitch);
  }
  CHECK(degrees(highest - lowest) == doctest::Approx(4.0F).epsilon(0.1));
  CHECK(degrees(highest + lowest) * 0.5F == doctest::Approx(30.0F).epsilon(0.01));
}

TEST_CASE("world: a kidnap moves the robot and tells nobody but the truth") {
  SimWorld world(options(5));
  for (int i = 0; i < 20; ++i) world.step(dt);
  const Activity before = world.state().activity;
  world.kidnap({1.0F, -0.5F, 2.0F});
  CHECK_FALSE(world.state().kidnapped);
  world.step(dt);
  CHECK(world.state().kidnapped);
  CHECK(world.state().pose.x == 1.0F);
  CHECK(world.state().pose.theta == 2.0F);
  CHECK(world.state().step.x == 0.0F);
  CHECK(world.state().activity == before);
  world.step(dt);
  CHECK_FALSE(world.state().kidnapped);
}

TEST_CASE("world: a fall tips the camera and keeps the place; a lift puts down elsewhere") {
  SimWorld world(options(6));
  world.step(dt);
  const Pose2 at = world.state().pose;
  world.fall(1.0F);
  world.step(dt);
  CHECK(world.state().activity == Activity::fallen);
  CHECK(world.state().camera.height < 0.3F);
  CHECK(std::abs(degrees(world.state().camera.pitch) - 30.0F) > 45.0F);
  for (int i = 0; i < 12; ++i) world.step(dt);
  CHECK(world.state().activity == Activity::walking);
  CHECK(std::hypot(world.state().pose.x - at.x, world.state().pose.y - at.y) < 0.05F);
  world.lift(0.5F, {-1.0F, 0.3F, 1.0F});
  world.step(dt);
  CHECK(world.state().activity == Activity::lifted);
  for (int i = 0; i < 5; ++i) world.step(dt);
  CHECK(world.state().activity == Activity::walking);
  CHECK(world.state().pose.x == doctest::Approx(-1.0F));
}

TEST_CASE("world: turning on the centre circle is one full turn there") {
  SimWorld world(options(7));
  world.turn_on_centre();
  float turned = 0.0F;
  for (int i = 0; i < 1200 && turned < 6.0F; ++i) {
    world.step(dt);
    if (world.state().activity != Activity::turning) continue;
    turned += world.state().step.theta;
    CHECK(std::hypot(world.state().pose.x, world.state().pose.y) < 0.5F);
  }
  CHECK(turned > 6.0F);
}

TEST_CASE("world: the seed decides everything") {
  SimWorld a(options(8));
  SimWorld b(options(8));
  SimWorld c(options(9));
  for (int i = 0; i < 100; ++i) {
    a.step(dt);
    b.step(dt);
    c.step(dt);
  }
  CHECK(a.state().pose.x == b.state().pose.x);
  CHECK(a.state().camera.roll == b.state().camera.roll);
  CHECK(a.state().pose.x != c.state().pose.x);
}
