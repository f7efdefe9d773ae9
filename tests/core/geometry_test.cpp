// SPDX-License-Identifier: Apache-2.0
#include "platform/core/geometry.h"

#include <doctest/doctest.h>

#include "platform/core/rng.h"

using namespace touchline;

namespace {
void check_near(float a, float b, float tolerance = 1e-5F) { CHECK(math::abs(a - b) < tolerance); }
Pose2 random_pose(Rng& rng) {
  return {rng.uniform(-7.0F, 7.0F), rng.uniform(-4.0F, 4.0F), rng.uniform(-math::pi, math::pi)};
}
}  // namespace

TEST_CASE("rotations follow the right-hand rule") {
  const Vec3 y = multiply(rotation_z(math::half_pi), Vec3{1.0F, 0.0F, 0.0F});
  check_near(y.y, 1.0F);
  const Vec3 z = multiply(rotation_x(math::half_pi), Vec3{0.0F, 1.0F, 0.0F});
  check_near(z.z, 1.0F);
  const Vec3 x = multiply(rotation_y(math::half_pi), Vec3{0.0F, 0.0F, 1.0F});
  check_near(x.x, 1.0F);
}

TEST_CASE("the transposed rotation takes a vector back") {
  const Mat3 rotation = multiply(rotation_z(0.3F), multiply(rotation_y(-1.1F), rotation_x(2.0F)));
  const Vec3 v{0.2F, -0.7F, 1.5F};
  const Vec3 back = multiply_transposed(rotation, multiply(rotation, v));
  check_near(back.x, v.x);
  check_near(back.y, v.y);
  check_near(back.z, v.z);
}

TEST_CASE("normalized makes unit length and leaves zero alone") {
  check_near(dot(normalized({3.0F, -4.0F, 12.0F}), {3.0F, -4.0F, 12.0F}), 13.0F);
  const Vec3 zero = normalized({});
  CHECK(dot(zero, zero) == 0.0F);
}

TEST_CASE("a point one metre ahead of a robot that faces left lies to the left on the field") {
  const FieldPoint p = to_field({1.0F, 2.0F, math::half_pi}, {1.0F, 0.0F});
  check_near(p.x, 1.0F);
  check_near(p.y, 3.0F);
}

TEST_CASE("ground and field are inverse, and so are poses") {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose = random_pose(rng);
    const GroundPoint ground{rng.uniform(-5.0F, 5.0F), rng.uniform(-5.0F, 5.0F)};
    const GroundPoint back = to_ground(pose, to_field(pose, ground));
    check_near(back.x, ground.x);
    check_near(back.y, ground.y);
    const Pose2 identity = compose(pose, inverse(pose));
    check_near(identity.x, 0.0F);
    check_near(identity.y, 0.0F);
    check_near(identity.theta, 0.0F);
  }
}

TEST_CASE("composition is a change of frame") {
  Rng rng(4);
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = random_pose(rng);
    const Pose2 b = random_pose(rng);
    const GroundPoint p{rng.uniform(-2.0F, 2.0F), rng.uniform(-2.0F, 2.0F)};
    const FieldPoint by_b = to_field(b, p);
    const FieldPoint in_steps = to_field(a, {by_b.x, by_b.y});
    const FieldPoint at_once = to_field(compose(a, b), p);
    check_near(in_steps.x, at_once.x, 2e-5F);
    check_near(in_steps.y, at_once.y, 2e-5F);
  }
}

TEST_CASE("the mirrored pose sees the mirrored point in the same place") {
  const Pose2 pose{1.0F, -0.5F, 0.7F};
  const GroundPoint one = to_ground(pose, {2.0F, 1.0F});
  const GroundPoint other = to_ground(mirrored(pose), {-2.0F, -1.0F});
  check_near(one.x, other.x);
  check_near(one.y, other.y);
  check_near(mirrored(mirrored(pose)).theta, pose.theta);
}
