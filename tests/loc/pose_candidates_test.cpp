// SPDX-License-Identifier: Apache-2.0
#include "loc/pose_candidates.h"

#include <doctest/doctest.h>

#include <memory>

#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {
bool close(const Pose2& a, const Pose2& b) {
  return math::hypot(a.x - b.x, a.y - b.y) < 0.3F && math::abs(angle_difference(a.theta, b.theta)) < radians(12.0F);
}

struct Fixture {
  Field field;
  std::unique_ptr<DistanceField> map = std::make_unique<DistanceField>();
  test::SyntheticView view;
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};
  LocalizerConfig config;
  std::unique_ptr<Observation> observation = std::make_unique<Observation>();
  CandidateList candidates;
  Rng rng{21};

  explicit Fixture(const char* preset) : field(test::field_of(preset)), view(field, test::paper_lens(), 752, 480) {
    map->build(field);
  }
  void find(const Pose2& truth, const test::SyntheticOptions& options, const YawEvidence& yaw) {
    make_observation(view.look(truth, camera, options, rng), config, *observation);
    find_candidates(field, *map, *observation, config, yaw, candidates);
  }
  [[nodiscard]] int rank_of(const Pose2& truth) const {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (close(candidates[i].pose, truth)) return static_cast<int>(i);
    }
    return 999;
  }
};
}  // namespace

TEST_CASE("without yaw, the true pose and its mirror are among the best four candidates, from any place") {
  for (const char* preset : {"acyut-5x3", "small-2026", "middle-2026"}) {
    Fixture f(preset);
    int good = 0;
    for (int i = 0; i < 40; ++i) {
      const Pose2 truth{f.rng.uniform(-0.5F, 0.5F) * f.field.dimensions().length,
                        f.rng.uniform(-0.5F, 0.5F) * f.field.dimensions().width, f.rng.uniform(-3.1F, 3.1F)};
      f.find(truth, {}, {});
      if (f.rank_of(truth) < 4 && f.rank_of(mirrored(truth)) < 4) ++good;
    }
    CAPTURE(preset);
    CHECK(good >= 36);  // where a lone line is in view no method can tell
  }
}

TEST_CASE("with yaw the mirror is no candidate") {
  Fixture f("acyut-5x3");
  const Pose2 truth{-1.0F, 0.5F, 0.3F};
  f.find(truth, {}, {true, 0.33F, radians(3.0F)});
  CHECK(f.rank_of(truth) == 0);
  CHECK(f.rank_of(mirrored(truth)) == 999);
}

TEST_CASE("lines without a junction find the pose by the grid, a junction without lines by its branches") {
  Fixture f("acyut-5x3");
  const Pose2 truth{-1.0F, 0.5F, 0.3F};
  test::SyntheticOptions no_junctions;
  no_junctions.junctions = false;
  f.find(truth, no_junctions, {});
  CHECK(f.rank_of(truth) < 4);
  test::SyntheticOptions no_lines;
  no_lines.lines = false;
  f.find(truth, no_lines, {});
  CHECK(f.rank_of(truth) < 4);
}

TEST_CASE("nothing seen, no candidates") {
  Fixture f("acyut-5x3");
  test::SyntheticOptions blind;
  blind.max_range = 0.0F;
  blind.junctions = false;
  f.find({}, blind, {});
  CHECK(f.candidates.empty());
}
