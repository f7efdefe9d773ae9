// SPDX-License-Identifier: Apache-2.0
#include "vision/node_graph.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

#include "tests/support/ascii_image.h"
#include "tests/vision/skeletons.h"
#include "vision/graph_storage.h"

namespace touchline {
namespace {

using test::Bits;

struct Graph {
  std::unique_ptr<GraphStorage<320, 240>> storage = std::make_unique<GraphStorage<320, 240>>();
  SkeletonIndex index{storage->memory().index};
  std::vector<MajorNode> majors;
  NodeGraphResult result;
  explicit Graph(const Bits& image, int spur_px = 6, const LineWidthView& widths = {}) {
    const GraphMemory memory = storage->memory();
    REQUIRE(index.build(image.view()));
    const DigestionResult digested = digest(index, {5, 1, 10, 100}, memory.digestion);
    majors.assign(digested.major_nodes.begin(), digested.major_nodes.end());
    result = build_node_graph(index, digested.major_nodes, widths, {spur_px}, memory.graph);
  }
  [[nodiscard]] int nodes_of_degree(int degree) const {
    return static_cast<int>(std::count_if(result.graph.nodes.begin(), result.graph.nodes.end(),
                                          [&](const GraphNode& n) { return n.degree == degree; }));
  }
  [[nodiscard]] const GraphNode& node_of_degree(int degree) const {
    return *std::find_if(result.graph.nodes.begin(), result.graph.nodes.end(),
                         [&](const GraphNode& n) { return n.degree == degree; });
  }
};

bool touching(GridPoint a, GridPoint b) { return std::abs(a.x - b.x) <= 1 && std::abs(a.y - b.y) <= 1; }

/// What holds for every graph: polylines are connected skeleton pixels, no pixel between ends belongs to two edges,
/// degrees agree with the edges.
void check_consistent(const Graph& g, const Bits& image) {
  const NodeGraphView& graph = g.result.graph;
  std::set<std::pair<int, int>> inner;
  std::vector<int> degree(graph.nodes.size());
  for (const GraphEdge& e : graph.edges) {
    const auto line = graph.polyline(e);
    REQUIRE(line.size() >= 2);
    for (std::size_t i = 0; i < line.size(); ++i) {
      REQUIRE(image.view().get(line[i].x, line[i].y));
      if (i > 0) REQUIRE(touching(line[i - 1], line[i]));
      const bool is_end = i == 0 || (i + 1 == line.size() && e.node_b != no_node);
      if (!is_end) REQUIRE(inner.insert({line[i].x, line[i].y}).second);
    }
    REQUIRE(e.node_a != no_node);
    ++degree[e.node_a];
    if (e.node_b != no_node) ++degree[e.node_b];
  }
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    REQUIRE(graph.nodes[i].degree == degree[i]);
    for (int k = 0; k < graph.nodes[i].degree; ++k) {
      const GraphEdge& e = graph.edges[graph.nodes[i].edge[k]];
      REQUIRE((e.node_a == i || e.node_b == i));
    }
  }
}

}  // namespace

TEST_CASE("an X has one node of degree 4, where the lines cross") {
  const Bits image = test::drawn_x();
  const Graph g(image);
  check_consistent(g, image);
  REQUIRE(g.nodes_of_degree(4) == 1);
  CHECK(g.nodes_of_degree(3) == 0);
  CHECK(g.node_of_degree(4).at.x == 20);
  CHECK(g.node_of_degree(4).at.y == 20);
}

TEST_CASE("a T has one node of degree 3") {
  const Bits image = test::bits({
      "########################################",
      "....................#...................",
      "....................#...................",
      "....................#...................",
      "....................#...................",
      "....................#...................",
      "....................#...................",
      "....................#...................",
      "....................#...................",
  });
  const Graph g(image);
  check_consistent(g, image);
  REQUIRE(g.nodes_of_degree(3) == 1);
  CHECK(g.nodes_of_degree(4) == 0);
  CHECK(g.node_of_degree(3).at.x == 20);
}

TEST_CASE("long lines have nodes of degree 2 along them, and free ends") {
  Bits image(200, 5);
  for (int x = 0; x < 200; ++x) image.view().set(x, 2, true);
  const Graph g(image);
  check_consistent(g, image);
  CHECK(g.nodes_of_degree(2) == static_cast<int>(g.majors.size()));
  CHECK(g.nodes_of_degree(2) >= 15);
  CHECK(std::count_if(g.result.graph.edges.begin(), g.result.graph.edges.end(),
                      [](const GraphEdge& e) { return e.node_b == no_node; }) == 2);
}

TEST_CASE("a short spur goes, a long branch stays") {
  for (const int length : {3, 5, 6, 12}) {
    Bits image(60, 20);
    for (int x = 0; x < 60; ++x) image.view().set(x, 2, true);
    for (int y = 3; y < 3 + length; ++y) image.view().set(30, y, true);
    const Graph g(image, 6);
    check_consistent(g, image);
    CAPTURE(length);
    CHECK(g.nodes_of_degree(3) == (length >= 6 ? 1 : 0));
    CHECK((g.result.spurs > 0) == (length < 6));
  }
}

TEST_CASE("both prongs at the end of a wide line go, the line stays") {
  const Bits image = test::bits({
      "##..................................",
      "..##................................",
      "....################################",
      "..##................................",
      "##..................................",
  });
  const Graph g(image, 6);
  check_consistent(g, image);
  CHECK(g.nodes_of_degree(3) == 0);
  CHECK(g.result.spurs == 2);
  CHECK(g.result.graph.edges.size() >= 3);
}

TEST_CASE("where lines look wide, spurs are longer") {
  Bits image(64, 24);
  for (int x = 0; x < 64; ++x) image.view().set(x, 2, true);
  for (int y = 3; y < 13; ++y) image.view().set(32, y, true);
  std::vector<LineWidth> table(8 * 3, LineWidth{20 * 16, 4 * 16});
  const Graph wide(image, 6, LineWidthView{table.data(), 8, 3, 8});
  CHECK(wide.nodes_of_degree(3) == 0);
  for (LineWidth& w : table) w = {10 * 16, 4 * 16};
  const Graph narrow(image, 6, LineWidthView{table.data(), 8, 3, 8});
  CHECK(narrow.nodes_of_degree(3) == 1);
}

TEST_CASE("a piece shorter than a spur goes, a single pixel is no line") {
  const Graph g(test::bits({"####......#", "...........", "..........."}), 6);
  CHECK(g.result.graph.edges.empty());
}

TEST_CASE("a closed loop that has no major node of its own gets one") {
  const Bits image = test::drawn_circle(24, 24, 8);
  auto storage = std::make_unique<GraphStorage<320, 240>>();
  const GraphMemory memory = storage->memory();
  SkeletonIndex index(memory.index);
  REQUIRE(index.build(image.view()));
  const NodeGraphResult r = build_node_graph(index, {}, {}, {6}, memory.graph);
  REQUIRE(r.graph.edges.size() == 1);
  CHECK(r.graph.edges[0].node_a == r.graph.edges[0].node_b);
  CHECK(static_cast<int>(r.graph.edges[0].point_count) == index.size() + 1);
  REQUIRE(r.graph.nodes.size() == 1);
  CHECK(r.graph.nodes[0].degree == 2);
}

TEST_CASE("seeded skeletons give consistent graphs") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    const Bits image = test::random_skeleton(seed);
    check_consistent(Graph(image, 0), image);
    check_consistent(Graph(image, 6), image);
  }
}

TEST_CASE("every pixel of thinned walks is in an edge or inside a fork") {
  for (unsigned seed = 0; seed < 200; seed += 4) {
    CAPTURE(seed);
    const Bits image = test::random_skeleton(seed);
    const Graph g(image, 0);
    CHECK(g.result.dropped_edges == 0);
    int holes = 0;
    std::set<std::pair<int, int>> seen;
    for (const GraphEdge& e : g.result.graph.edges) {
      for (const GridPoint p : g.result.graph.polyline(e)) seen.insert({p.x, p.y});
    }
    for (const GridPoint p : g.index.pixels()) {
      const unsigned steps = steps_of(g.index.neighbours(p));
      const bool in_fork = std::popcount(steps) >= 3 || steps == 0;
      // A pixel of two ways may close a hole of some pixels inside a fork; none of these walks has more than a few.
      holes += !in_fork && seen.count({p.x, p.y}) == 0 ? 1 : 0;
    }
    CHECK(holes <= 4);
  }
}

TEST_CASE("what has no room is counted and the rest is valid") {
  const Bits image = test::random_skeleton(2);
  auto storage = std::make_unique<GraphStorage<320, 240>>();
  GraphMemory memory = storage->memory();
  SkeletonIndex index(memory.index);
  REQUIRE(index.build(image.view()));
  const DigestionResult digested = digest(index, {5, 1, 10, 100}, memory.digestion);
  memory.graph.nodes = memory.graph.nodes.first(9);
  memory.graph.edges = memory.graph.edges.first(4);
  memory.graph.points = memory.graph.points.first(20);
  const NodeGraphResult r = build_node_graph(index, digested.major_nodes, {}, {0}, memory.graph);
  CHECK(r.graph.nodes.size() == 9);
  CHECK(r.graph.edges.size() <= 4);
  CHECK(r.dropped_nodes > 0);
  CHECK(r.dropped_edges > 0);
  CHECK(r.dropped_points > 0);
}

TEST_CASE("the worst frames fill the memory and are counted") {
  for (const int pattern : {0, 1, 2}) {
    Bits image(320, 240);
    if (pattern == 0) image = test::random_bits(320, 240, 50, 1);
    for (int y = 0; y < 240 && pattern > 0; ++y) {
      for (int x = 0; x < 320; ++x) image.view().set(x, y, pattern == 1 ? (x + y) % 2 == 0 : x % 3 == 0 || y % 3 == 0);
    }
    const Graph g(image);
    CHECK(g.index.dropped() > 0);
    CHECK(g.index.size() > 2800);
    check_consistent(g, image);
  }
}

}  // namespace touchline
