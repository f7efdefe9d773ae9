// SPDX-License-Identifier: Apache-2.0
// Which of Canny's edges bound a line, and why the others do not.
#include "vision/candidates.h"

#include <doctest/doctest.h>

#include <memory>

#include "tests/vision/drawn_carpet.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Outcome {
  int taken = 0;
  int edges = 0;
  std::array<int, candidate_rejections> rejected{};
  Bits lines;
  [[nodiscard]] int count_of(CandidateRejection reason) const { return rejected[static_cast<std::size_t>(reason)]; }
};

Outcome edges_of(const Drawing& d) {
  Outcome o;
  Bits all(d.w, d.h), weak(d.w, d.h), edges(d.w, d.h);
  fill(all.view());
  o.lines = Bits(d.w, d.h);
  const auto canny = std::make_unique<CannyStorage<320>>();
  const GrowResult grown =
      find_edges(d.image().y, all.view(), edge_thresholds(d.carpet), canny->memory(), weak.view(), edges.view());
  CHECK(grown.finished);
  o.edges = count(edges.view());
  o.taken = add_line_edges({d.image().y, edges.view(), d.green.view(), d.white.view(), d.table()}, o.lines.view(),
                           o.rejected);
  return o;
}

}  // namespace

TEST_CASE("the edges of a line are candidates, with the white between them") {
  Drawing d(upright("ggggggggWWgggggggg"), four_px);
  const Outcome o = edges_of(d);
  CHECK(o.edges >= 2 * d.h - 4);
  CHECK(o.taken > 0);
  for (int y = 0; y < d.h; ++y) {
    CHECK(o.lines.view().get(17, y));
    CHECK(o.lines.view().get(18, y));
    CHECK_FALSE(o.lines.view().get(12, y));
    CHECK_FALSE(o.lines.view().get(23, y));
  }
}

TEST_CASE("a shadow's edge has no white beside it") {
  const Outcome o = edges_of(Drawing(upright("ssssssssgggggggggg"), four_px));
  CHECK(o.edges > 0);
  CHECK(o.taken == 0);
  CHECK(o.count_of(CandidateRejection::edge_without_white) == o.edges);
}

TEST_CASE("white that does not end within a line's width is floor") {
  const Outcome o = edges_of(Drawing(upright("ggggggggggffffffff"), four_px));
  CHECK(o.edges > 0);
  CHECK(o.taken == 0);
  CHECK(o.count_of(CandidateRejection::edge_of_wide) == o.edges);
}

TEST_CASE("an edge away from the green is clutter") {
  const Outcome o = edges_of(Drawing(upright("gggggffffffffkkkkkkkffff"), four_px));
  CHECK(o.taken == 0);
  CHECK(o.count_of(CandidateRejection::edge_without_green) > 0);
}

TEST_CASE("a lying stripe that is too high for its slope is none") {
  std::vector<std::string> rows(14, "gggggggggggggggggggggggg");
  rows[5] = rows[6] = rows[7] = rows[8] = "gffffffffffffffffffffffg";
  const Outcome o = edges_of(Drawing(rows, {80, 16, 90}));
  CHECK(o.count_of(CandidateRejection::edge_of_wide) > 50);
  CHECK_FALSE(o.lines.view().get(24, 13));
}

TEST_CASE("each reason has a name") {
  for (std::size_t i = 0; i < candidate_rejections; ++i) {
    CHECK(std::string(to_string(static_cast<CandidateRejection>(i))) != "unknown reason");
  }
}
