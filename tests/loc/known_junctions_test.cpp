// SPDX-License-Identifier: Apache-2.0
#include "loc/known_junctions.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>

#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {
constexpr float sure = 0.8F;

struct Fixture {
  Field field = test::field_of("acyut-5x3");
  test::SyntheticView view{field, test::paper_lens(), 752, 480};
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};
  Pose2 truth{1.2F, 0.3F, 0.2F};  // before the opponent's goal area
  test::SyntheticOptions options;
  PoseEstimate estimate;
  std::unique_ptr<VisionResult> vision = std::make_unique<VisionResult>();
  Features features;
  KnownJunctions known;
  Rng rng{7};

  Fixture() {
    estimate.valid = true;
    estimate.pose = truth;
    estimate.covariance = {1e-4F, 0.0F, 1e-4F, 0.0F, 0.0F, 1e-5F};
    estimate.confidence = 1.0F;
    estimate.explained = 0.9F;
  }
  /// Vision's features are copied, so that a test may change them.
  void look() {
    *vision = view.look(truth, camera, options, rng);
    features = *vision->features;
    vision->features = &features;
  }
  void check() { check_junctions(field, *vision, estimate, sure, known); }
  [[nodiscard]] int count(JunctionSource source) const {
    return static_cast<int>(
        std::count_if(known.list.begin(), known.list.end(), [&](const auto& k) { return k.source == source; }));
  }
  /// The reported junction of that type at a pixel of the true picture.
  [[nodiscard]] const KnownJunction* at(const FieldPoint& place, JunctionType type) const {
    const GroundPoint ground = to_ground(truth, place);
    for (const KnownJunction& k : known.list) {
      if (k.junction.type == type &&
          math::hypot(k.junction.ground.x - ground.x, k.junction.ground.y - ground.y) < 0.02F)
        return &k;
    }
    return nullptr;
  }
};

const FieldPoint goal_area_corner{2.05F, 0.90F};
}  // namespace

TEST_CASE("what vision reports where the field has it is confirmed, each junction once") {
  Fixture f;
  f.look();
  const int reported = static_cast<int>(f.features.junctions.size());
  REQUIRE(reported > 4);
  f.check();
  CHECK(f.count(JunctionSource::both) == reported);
  CHECK(f.count(JunctionSource::picture) == 0);
  CHECK(f.known.turned_down == 0);
}

TEST_CASE("a junction that the graph lost is reported where its branches are in the picture") {
  Fixture f;
  f.options.junctions = false;
  f.look();
  f.check();
  const KnownJunction* corner = f.at(goal_area_corner, JunctionType::l);
  REQUIRE(corner != nullptr);
  CHECK(corner->source == JunctionSource::map);
  PixelPoint truth;
  REQUIRE(f.vision->projection.pixel(to_ground(f.truth, goal_area_corner), truth));
  CHECK(corner->junction.pixel.u == doctest::Approx(static_cast<double>(truth.u)).epsilon(0.001));
  CHECK(corner->junction.pixel.v == doctest::Approx(static_cast<double>(truth.v)).epsilon(0.001));
  CHECK(corner->junction.branches == 2);
}

TEST_CASE("branches that are the circle's are looked for along the circle") {
  Fixture f;
  f.truth = f.estimate.pose = {-1.0F, 0.3F, 0.0F};
  f.options.junctions = false;
  f.look();
  f.check();
  const KnownJunction* crossing = f.at({0.0F, 0.5F}, JunctionType::x);
  REQUIRE(crossing != nullptr);
  CHECK(crossing->source == JunctionSource::map);
  CHECK(crossing->junction.branches == 4);
}

TEST_CASE("where a branch is not in the picture, the map alone reports nothing") {
  Fixture f;
  f.options.junctions = false;
  f.look();
  // A robot stands on the goal area's front line: the mask is empty around a point of it.
  PixelPoint p;
  REQUIRE(f.vision->projection.pixel(to_ground(f.truth, {2.05F, 0.70F}), p));
  BitImage<320, 240> lines;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) lines.view().set(x, y, f.vision->line_mask.get(x, y));
  }
  const int x0 = static_cast<int>(p.u * 320.0F / 752.0F);
  const int y0 = static_cast<int>(p.v * 0.5F);
  for (int y = y0 - 6; y <= y0 + 6; ++y) {
    for (int x = x0 - 6; x <= x0 + 6; ++x) lines.view().set(x, y, false);
  }
  f.vision->line_mask = lines.view();
  f.check();
  CHECK(f.at(goal_area_corner, JunctionType::l) == nullptr);
}

TEST_CASE("what vision reports where the field has nothing of the kind is turned down") {
  Fixture f;
  f.look();
  Junction bogus = f.features.junctions[0];
  bogus.type = JunctionType::x;
  bogus.ground = {0.8F, 0.0F};  // bare carpet
  REQUIRE(f.vision->projection.pixel(bogus.ground, bogus.pixel));
  f.features.junctions.push_back(bogus);
  f.check();
  CHECK(f.known.turned_down == 1);
  CHECK(f.count(JunctionSource::picture) == 0);
}

TEST_CASE("a junction that was measured badly is put where the field has it") {
  Fixture f;
  f.look();
  Junction* corner = std::find_if(f.features.junctions.begin(), f.features.junctions.end(), [&](const Junction& j) {
    const GroundPoint ground = to_ground(f.truth, goal_area_corner);
    return j.type == JunctionType::l && math::hypot(j.ground.x - ground.x, j.ground.y - ground.y) < 0.02F;
  });
  REQUIRE(corner != f.features.junctions.end());
  corner->pixel.u += 5.0F;
  f.check();
  const KnownJunction* known = f.at(goal_area_corner, JunctionType::l);
  REQUIRE(known != nullptr);
  CHECK(known->source == JunctionSource::both);
  CHECK(f.known.turned_down == 0);
}

TEST_CASE("the mount's errors are taken out before the field is laid on the picture") {
  Fixture f;
  f.options.junctions = false;
  f.options.pitch_error = radians(2.0F);
  f.options.roll_error = radians(-1.5F);
  f.look();
  f.check();
  CHECK(f.at(goal_area_corner, JunctionType::l) == nullptr);
  f.estimate.pitch_error = f.options.pitch_error;
  f.estimate.roll_error = f.options.roll_error;
  f.check();
  CHECK(f.at(goal_area_corner, JunctionType::l) != nullptr);
}

TEST_CASE("a pose that is vague there confirms, moves and adds nothing; it turns down only what is far off") {
  Fixture f;
  f.look();
  f.estimate.covariance = {0.01F, 0.0F, 0.01F, 0.0F, 0.0F, 0.001F};
  f.features.junctions.truncate(1);
  f.features.junctions[0].pixel.u += 3.0F;
  const PixelPoint seen = f.features.junctions[0].pixel;
  f.check();
  REQUIRE(f.known.list.size() == 1);
  CHECK(f.known.list[0].junction.pixel.u == seen.u);
}

TEST_CASE("without a sure pose all that vision reports is passed on as it is") {
  Fixture f;
  f.look();
  for (const bool unexplained : {false, true}) {
    f.estimate.confidence = unexplained ? 1.0F : 0.5F;
    f.estimate.explained = unexplained ? 0.3F : 0.9F;
    f.check();
    CHECK(f.count(JunctionSource::picture) == static_cast<int>(f.features.junctions.size()));
    CHECK(f.known.list.size() == f.features.junctions.size());
  }
  f.estimate.valid = false;
  f.check();
  CHECK(f.count(JunctionSource::picture) == static_cast<int>(f.features.junctions.size()));
}
