// SPDX-License-Identifier: Apache-2.0
// The acceptance scenes: seeded, spread as the order says, with the truth beside them.
#include "platform/host/sim/scenario.h"

#include <doctest/doctest.h>

#include <cmath>

#include "platform/core/hash.h"
#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

std::uint64_t hash_of(const FrameView& image) {
  return hash_bytes(image.data, static_cast<std::size_t>(image.height) * static_cast<std::size_t>(image.stride_bytes));
}

PoseScenarioOptions poses(std::uint64_t seed) {
  PoseScenarioOptions o;
  o.field = small_field();
  o.camera = *camera_model("fisheye-185");
  o.seed = seed;
  return o;
}

}  // namespace

TEST_CASE("scenario: cameras by name") {
  for (const char* name : {"fisheye-185", "fisheye-185-qvga", "fisheye-140", "fisheye-140-kb"}) {
    const auto model = camera_model(name);
    REQUIRE(model.has_value());
    Lens lens;
    REQUIRE(Lens::create(model->lens, lens) == Status::ok);
    CHECK(lens.max_radius() == doctest::Approx(static_cast<float>(model->width) * 0.5F).epsilon(0.01));
  }
  CHECK_FALSE(camera_model("pinhole").has_value());
}

TEST_CASE("scenario: a single picture does not depend on those drawn before") {
  PoseScenario a(poses(3));
  PoseScenario b(poses(3));
  REQUIRE(a.ready());
  a.frame(0);
  a.frame(9);
  const SimFrame first = a.frame(4);
  const std::uint64_t hash = hash_of(first.image);
  const SimFrame second = b.frame(4);
  CHECK(hash == hash_of(second.image));
  CHECK(first.truth.x == second.truth.x);
  PoseScenario c(poses(4));
  CHECK(hash != hash_of(c.frame(4).image));
}

TEST_CASE("scenario: poses lie inside the lines, pitch within its limits, no yaw") {
  PoseScenarioOptions o = poses(5);
  o.camera.width = 16;  // small pictures: only the numbers matter here
  o.camera.height = 16;
  o.camera.lens.cx = o.camera.lens.cy = 8.0F;
  o.camera.lens.focal_px = 5.0F;
  PoseScenario scenario(o);
  REQUIRE(scenario.ready());
  double off = 0.0;
  int halves = 0;
  for (int i = 0; i < 80; ++i) {
    const SimFrame& f = scenario.frame(i);
    CHECK(std::abs(f.truth.x) < 2.45F);
    CHECK(std::abs(f.truth.y) < 1.45F);
    CHECK(degrees(f.true_camera.pitch) >= 20.0F);
    CHECK(degrees(f.true_camera.pitch) <= 42.0F);
    CHECK(f.true_camera.yaw == 0.0F);
    CHECK_FALSE(f.has_yaw);
    halves += f.truth.x > 0.0F ? 1 : 0;
    off += std::pow(static_cast<double>(f.mount.pitch - f.true_camera.pitch), 2.0);
  }
  CHECK(halves > 25);
  CHECK(halves < 55);
  CHECK(std::sqrt(off / 80.0) == doctest::Approx(static_cast<double>(radians(0.5F))).epsilon(0.25));
}

TEST_CASE("scenario: a walk repeats, and drawing changes nothing of the motion") {
  const SimCameraModel camera = *camera_model("fisheye-140");
  WalkScenarioOptions o = acceptance_walk(small_field(), camera, 6);
  WalkScenario a(o);
  WalkScenario b(o);
  REQUIRE(a.ready());
  for (int i = 0; i < 6; ++i) {
    const SimFrame fa = a.next();
    const SimFrame fb = b.next(i == 5);
    CHECK(fa.truth.x == fb.truth.x);
    CHECK(fa.odometry.x == fb.odometry.x);
    CHECK(fa.yaw == fb.yaw);
    CHECK(fa.mount.pitch == fb.mount.pitch);
    if (i == 5) CHECK(hash_of(fa.image) == hash_of(fb.image));
  }
}

TEST_CASE("scenario: kidnap unannounced, fall and lift announced") {
  WalkScenarioOptions o = acceptance_walk(small_field(), *camera_model("fisheye-140"), 7);
  o.kidnap_at_s = 2.0;
  o.fall_at_s = 4.0;
  o.lift_at_s = 10.0;
  WalkScenario walk(o);
  int kidnaps = 0;
  int by_hand = 0;
  int still = 0;
  Pose2 before;
  for (int i = 0; i < 180; ++i) {
    const SimFrame& f = walk.next(false);
    if (f.kidnapped) {
      kidnaps += 1;
      CHECK(f.time_s == doctest::Approx(2.0).epsilon(0.05));
      CHECK(std::abs(f.odometry.x) < 0.03F);  // no more than the steps before the hand came
      CHECK_FALSE(f.moved_by_hand);
      CHECK(std::hypot(f.truth.x - before.x, f.truth.y - before.y) > 0.1F);
    }
    if (f.moved_by_hand) {
      by_hand += 1;
      CHECK(std::abs(f.odometry.theta) < 0.03F);
      still += f.odometry.theta == 0.0F ? 1 : 0;
    }
    before = f.truth;
  }
  CHECK(kidnaps == 1);
  CHECK(by_hand == doctest::Approx(72).epsilon(0.1));
  CHECK(still > by_hand - 4);
}

// Holds compilers and optimisation levels to the same frames: a difference shows as another hash. A deliberate change
// of the simulator changes it too: then copy the new value from the failure.
TEST_CASE("scenario: the same bytes from every compiler") {
  PoseScenario scenario(poses(77));
  std::uint64_t hash = hash_seed;
  for (int i = 0; i < 2; ++i) {
    const SimFrame& f = scenario.frame(i * 8);
    hash = hash_bytes(&f.truth, sizeof f.truth, hash_of(f.image) ^ hash);
  }
  CHECK(hash == 0x51dbad4eff060821ULL);
}
