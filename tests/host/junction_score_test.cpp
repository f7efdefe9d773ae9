// SPDX-License-Identifier: Apache-2.0
// Precision and recall of junctions, on hand-made ones.
#include "platform/host/junction_score.h"

#include <doctest/doctest.h>

#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

Junction junction(JunctionType type, float u, float v, float x) {
  Junction j;
  j.type = type;
  j.pixel = {u, v};
  j.ground = {x, 0.0F};
  return j;
}
const JunctionCount& count(const JunctionScore& score, JunctionType type) {
  return score[static_cast<std::size_t>(type)];
}

TEST_CASE("found, missed, false and neutral junctions are told apart") {
  const std::vector<ExpectedLandmark> expected{
      {JunctionType::t, {100.0F, 100.0F}, 1.0F, false},  // found
      {JunctionType::t, {200.0F, 100.0F}, 2.0F, false},  // missed: 4.1 px away
      {JunctionType::t, {300.0F, 100.0F}, 3.0F, false},  // too far to be asked for
      {JunctionType::t, {400.0F, 100.0F}, 1.0F, true},   // hidden
      {JunctionType::l, {500.0F, 100.0F}, 1.0F, false},  // only a T there
  };
  const std::vector<Junction> reported{
      junction(JunctionType::t, 102.0F, 103.0F, 1.0F), junction(JunctionType::t, 204.1F, 100.0F, 2.0F),
      junction(JunctionType::t, 300.0F, 100.0F, 2.4F), junction(JunctionType::t, 400.0F, 100.0F, 1.0F),
      junction(JunctionType::t, 500.0F, 100.0F, 1.0F), junction(JunctionType::x, 50.0F, 50.0F, 2.6F)};
  const JunctionScore score = score_junctions(expected, reported);
  const auto& t = count(score, JunctionType::t);
  CHECK(t.to_find == 2);
  CHECK(t.found == 1);
  CHECK(t.right == 2);
  CHECK(t.wrong == 2);
  CHECK(t.recall() == doctest::Approx(0.5));
  CHECK(t.precision() == doctest::Approx(0.5));
  CHECK(count(score, JunctionType::l).to_find == 1);
  CHECK(count(score, JunctionType::l).found == 0);
  CHECK(count(score, JunctionType::x).wrong == 0);  // beyond 2.5 m
}

TEST_CASE("expected landmarks are read beside the images; a broken file is an error, no file is none") {
  const TempFolder folder;
  const auto image = folder.write("images/007.png", "");
  CHECK_FALSE(read_expected(image).has_value());
  folder.write("expected/007.json",
               R"({"landmarks": [{"type": "X", "px": [1.5, 2.5], "range_m": 1.25, "occluded": true},)"
               R"({"type": "P", "px": [1, 2], "range_m": 1, "occluded": false}]})");
  const auto expected = read_expected(image);
  REQUIRE(expected.has_value());
  REQUIRE(expected->size() == 1);
  CHECK((*expected)[0].type == JunctionType::x);
  CHECK((*expected)[0].pixel.v == 2.5F);
  CHECK((*expected)[0].occluded);
  folder.write("expected/007.json", R"({"landmarks": [{"type": "X"}]})");
  CHECK(contains(error_of([&] { (void)read_expected(image); }), "007.json: not a list of expected landmarks"));
}

}  // namespace
}  // namespace touchline::host
