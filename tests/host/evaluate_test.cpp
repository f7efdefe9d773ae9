// SPDX-License-Identifier: Apache-2.0
// The protocols on a recording with truth: fixtures/sim-walk has lines to be seen.
#include "platform/host/evaluate.h"

#include <cmath>

#include <doctest/doctest.h>

#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

DataSet walk() {
  DataSet set = read_dataset(std::filesystem::path(TOUCHLINE_FIXTURES) / "sim-walk");
  if (set.frames.size() > 6) set.frames.resize(6);
  return set;
}

TEST_CASE("independent: each frame is a start from nothing, shown until it settles") {
  DataSet set = walk();
  set.protocol = Protocol::independent;
  const SetResult all = evaluate(set, {});
  REQUIRE(all.frames.size() == set.frames.size());
  for (const auto& record : all.frames) {
    CHECK(record.shows >= 1);
    CHECK(record.shows <= max_shows);
    CHECK(record.settled == (record.shows < max_shows || record.estimate.settled));
    REQUIRE(record.error.has_value());
  }
  CHECK_FALSE(all.sequence.has_value());
  // A frame alone gives what it gave among others, but for the seed that follows its place.
  DataSet one = set;
  one.frames = {set.frames[2]};
  EvaluateOptions options;
  options.seed += 2;
  const SetResult alone = evaluate(one, options);
  CHECK(alone.frames[0].estimate.pose.x == all.frames[2].estimate.pose.x);
  CHECK(alone.frames[0].shows == all.frames[2].shows);
}

TEST_CASE("sequence: one update a frame, and the same again") {
  const DataSet set = walk();
  REQUIRE(set.protocol == Protocol::sequence);
  const SetResult first = evaluate(set, {});
  const SetResult second = evaluate(set, {});
  CHECK(first.sequence.has_value());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    CHECK(first.frames[i].shows == 1);
    CHECK(first.frames[i].estimate.pose.x == second.frames[i].estimate.pose.x);
    CHECK(first.frames[i].estimate.pose.theta == second.frames[i].estimate.pose.theta);
  }
}

TEST_CASE("sequence: the odometry and the kidnap of a frame that cannot be used are the next one's") {
  DataSet set = walk();
  set.frames[2].path = "/no/such/image.png";
  set.frames[2].kidnap = true;
  const Pose2 sum = compose(set.frames[2].odometry, set.frames[3].odometry);
  const SetResult result = evaluate(set, {});
  REQUIRE(result.frames.size() == set.frames.size());
  CHECK(contains(result.frames[2].failure, "no such image"));
  CHECK(result.frames[2].shows == 0);
  CHECK(result.frames[3].failure.empty());
  CHECK(result.frames[3].frame.kidnap);
  CHECK(result.frames[3].frame.odometry.x == sum.x);
  CHECK(result.frames[3].frame.odometry.theta == sum.theta);
  CHECK(result.frames[4].frame.odometry.x == set.frames[4].odometry.x);
  CHECK_FALSE(result.frames[4].frame.kidnap);
  CHECK(summarize(result).failed == 1);
}

TEST_CASE("no localization ever sees the truth") {
  DataSet set = walk();
  const SetResult with = evaluate(set, {});
  for (auto& frame : set.frames) {
    frame.has_truth = false;
    frame.truth = {};
  }
  const SetResult without = evaluate(set, {});
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    CHECK(with.frames[i].estimate.pose.y == without.frames[i].estimate.pose.y);
    CHECK_FALSE(without.frames[i].error.has_value());
  }
}

TEST_CASE("a frame without a pose is infinitely far in the summary") {
  FrameRecord lost;
  lost.frame.has_truth = true;
  lost.error = PoseError{};
  FrameRecord found = lost;
  found.estimate.valid = true;
  found.error->has_pose = true;
  found.error->distance_m = 0.1;
  const FrameRecord* const records[] = {&lost, &found};
  const Summary sum = summarize(records);
  CHECK(sum.without_pose == 1);
  CHECK(sum.within(0.1) == 1);
  CHECK(sum.within(1e9) == 1);
  CHECK(std::isinf(sum.worst_m()));
}

}  // namespace
}  // namespace touchline::host
