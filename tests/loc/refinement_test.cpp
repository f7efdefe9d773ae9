// SPDX-License-Identifier: Apache-2.0
#include "loc/refinement.h"

#include <doctest/doctest.h>

#include <memory>

#include "loc/localizer_config.h"
#include "tests/support/synthetic_view.h"
#include "tests/support/test_field.h"

using namespace touchline;

namespace {
struct Fixture {
  Field field = test::field_of("acyut-5x3");
  test::SyntheticView view{field, test::paper_lens(), 752, 480};
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), radians(1.0F)};
  LocalizerConfig config;
  std::unique_ptr<Observation> observation = std::make_unique<Observation>();
  Rng rng{11};

  void look(const Pose2& truth, const test::SyntheticOptions& options) {
    make_observation(view.look(truth, camera, options, rng), config, *observation);
  }
  Refinement refine(const Pose2& start, const RefinementPrior& prior = {}) const {
    return refine_pose(quarter_lines(field), observation->lines.view(), camera, start, prior, portable_loc_kernels());
  }
};
}  // namespace

TEST_CASE("from 0.2 m and 6 degrees off, the refined pose is the truth") {
  Fixture f;
  for (const Pose2& truth : {Pose2{-1.2F, 0.4F, 0.2F}, Pose2{0.8F, -0.9F, 2.5F}, Pose2{2.0F, 1.0F, -3.0F}}) {
    CAPTURE(truth.x);
    f.look(truth, {});
    const Refinement r = f.refine({truth.x + 0.15F, truth.y - 0.13F, truth.theta + 0.1F});
    CHECK(r.converged);
    CHECK(math::hypot(r.pose.x - truth.x, r.pose.y - truth.y) < 0.004F);
    CHECK(math::abs(angle_difference(r.pose.theta, truth.theta)) < 0.003F);
    CHECK(r.explained > 0.95F);
  }
}

TEST_CASE("an attitude error is found and does not pull the pose") {
  Fixture f;
  const Pose2 truth{-1.2F, 0.4F, 0.2F};
  test::SyntheticOptions options;
  options.pitch_error = radians(0.6F);
  options.roll_error = radians(-0.4F);
  f.look(truth, options);
  const Refinement r = f.refine(truth);
  CHECK(r.pitch_error == doctest::Approx(static_cast<double>(options.pitch_error)).epsilon(0.15));
  CHECK(r.roll_error == doctest::Approx(static_cast<double>(options.roll_error)).epsilon(0.15));
  CHECK(math::hypot(r.pose.x - truth.x, r.pose.y - truth.y) < 0.01F);
}

TEST_CASE("a third of the points on no line at all does little harm") {
  Fixture f;
  const Pose2 truth{-1.2F, 0.4F, 0.2F};
  f.look(truth, {});
  for (std::size_t i = 0; i < f.observation->lines.size(); i += 3) {
    LineSample s = f.observation->lines[i];
    const float away = f.camera.height / 0.5F;
    s.ground = {away * (0.6F + 0.8F * f.rng.uniform()), away * f.rng.uniform(-0.7F, 0.7F)};
    f.observation->lines.set(i, s);
  }
  const Refinement r = f.refine({truth.x - 0.1F, truth.y - 0.1F, truth.theta - 0.05F});
  CHECK(math::hypot(r.pose.x - truth.x, r.pose.y - truth.y) < 0.02F);
  CHECK(r.explained < 0.9F);
}

TEST_CASE("with nothing seen the start comes back, and the covariance says that nothing is known") {
  Fixture f;
  const Refinement r = f.refine({1.0F, 0.5F, 0.3F});
  CHECK(r.pose.x == doctest::Approx(1.0));
  CHECK(r.covariance.xx > 0.2F);
}

TEST_CASE("a prior holds the pose along a lone line, and the covariance shows the open direction") {
  Fixture f;
  const Pose2 truth{0.0F, -0.7F, -math::half_pi};  // looks at the touch line
  test::SyntheticOptions options;
  options.max_range = 0.9F;
  f.look(truth, options);
  // Keep the touch line alone: points that lie across the view.
  LineSamples<max_line_samples> lone;
  for (std::size_t i = 0; i < f.observation->lines.size(); ++i) {
    const LineSample s = f.observation->lines[i];
    if (math::abs(s.dir_y) > 0.9F && s.ground.x > 0.6F) lone.push_back(s);
  }
  REQUIRE(lone.size() > 10);
  RefinementPrior prior;
  prior.has_pose = true;
  prior.pose = truth;
  prior.covariance = {0.01F, 0, 0.01F, 0, 0, 0.003F};
  const Refinement r = refine_pose(quarter_lines(f.field), lone.view(), f.camera, truth, prior, portable_loc_kernels());
  CHECK(r.covariance.xx > 5.0F * r.covariance.yy);
  CHECK(math::abs(r.pose.x) < 0.03F);
}
