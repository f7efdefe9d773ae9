// SPDX-License-Identifier: Apache-2.0
// The paper's matrix Algorithm 1, written plainly, is the oracle for digestion on the forest.
#include "vision/digestion.h"

#include <doctest/doctest.h>

#include <memory>
#include <vector>

#include "platform/core/rng.h"
#include "tests/support/ascii_image.h"
#include "tests/vision/skeletons.h"
#include "vision/graph_storage.h"

namespace touchline {
namespace {

using test::Bits;

struct Matrix {
  int width, height;
  std::vector<int> cells;
  Matrix(int w, int h) : width(w), height(h), cells(static_cast<std::size_t>(w * h)) {}
  int& at(int x, int y) { return cells[static_cast<std::size_t>(y * width + x)]; }
};

struct MatrixDigestion {
  Matrix digest_wt, cij;
};

/// Algorithm 1 line by line (reading notes 3 to 7): the neighbourhood count leaves the pixel itself out, a digested
/// node is a secondary node again, ties go to the first pixel in raster order, only skeleton pixels take part.
MatrixDigestion matrix_digestion(const Bits& image, const DigestionParameters& p) {
  const ConstBitView img = image.view();
  MatrixDigestion m{Matrix(img.width, img.height), Matrix(img.width, img.height)};
  for (int y = 0; y < img.height; ++y) {
    for (int x = 0; x < img.width; ++x) {
      if (!img.get(x, y)) continue;
      m.cij.at(x, y) = 1;
      int white_cnt = -1;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) white_cnt += img.get(x + dx, y + dy) ? 1 : 0;
      }
      m.digest_wt.at(x, y) = white_cnt <= 1   ? 0
                             : white_cnt == 2 ? p.low_weight
                             : white_cnt == 3 ? p.medium_weight
                                              : p.high_weight;
    }
  }
  const int r = p.radius_px;
  for (int y = 0; y < img.height; ++y) {
    for (int x = 0; x < img.width; ++x) {
      if (!img.get(x, y)) continue;
      int best = 0, bx = 0, by = 0, sum = 0;
      for (int pass = 0; pass < 2; ++pass) {
        for (int ky = y - r; ky <= y + r; ++ky) {
          for (int kx = x - r; kx <= x + r; ++kx) {
            if (!img.get(kx, ky) || (kx - x) * (kx - x) + (ky - y) * (ky - y) > r * r) continue;
            int& weight = m.digest_wt.at(kx, ky);
            if (pass == 0) {
              sum += weight;
              if (weight > best) best = weight, bx = kx, by = ky;
            } else if (best > 0 && (kx != bx || ky != by)) {
              weight = 0;
              m.cij.at(kx, ky) = 1;
            }
          }
        }
        if (pass == 0 && best == 0) break;
      }
      if (best == 0) continue;
      m.digest_wt.at(bx, by) = sum;
      m.cij.at(bx, by) = 2;
    }
  }
  return m;
}

struct Forest {
  std::unique_ptr<GraphStorage<640, 480>> storage = std::make_unique<GraphStorage<640, 480>>();
  GraphMemory memory = storage->memory();
  SkeletonIndex index{memory.index};
  DigestionResult result;
  Forest(const Bits& image, const DigestionParameters& p) {
    REQUIRE(index.build(image.view()));
    result = digest(index, p, memory.digestion);
  }
};

void check_against_matrix(const Bits& image, const DigestionParameters& p) {
  MatrixDigestion oracle = matrix_digestion(image, p);
  const Forest forest(image, p);
  REQUIRE(forest.index.dropped() == 0);
  REQUIRE(forest.result.dropped == 0);
  std::vector<MajorNode> expected;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (oracle.cij.at(x, y) != 2) continue;
      expected.push_back({{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)}, oracle.digest_wt.at(x, y)});
    }
  }
  bool equal = expected.size() == forest.result.major_nodes.size();
  for (std::size_t i = 0; equal && i < expected.size(); ++i) {
    const MajorNode& a = expected[i];
    const MajorNode& b = forest.result.major_nodes[i];
    equal = a.at.x == b.at.x && a.at.y == b.at.y && a.weight == b.weight;
  }
  if (!equal) MESSAGE(test::ascii(image));
  REQUIRE(equal);
}

const Bits tee = test::bits({
    "....................",
    ".##################.",
    "..........#.........",
    "..........#.........",
    "..........#.........",
    "..........#.........",
    "..........#.........",
    "....................",
});

}  // namespace

TEST_CASE("the forest finds the major nodes of the matrix form on drawn skeletons") {
  for (const Bits& image : {tee, test::drawn_x(), test::drawn_l(), test::drawn_circle(60, 40, 15), test::bits({"#"}),
                            test::bits({"##", "##"}), Bits(0, 0), Bits(5, 5)}) {
    for (const int radius : {0, 1, 3, 5, 7, 8, 15, 16, 20, 31, 32, 50})
      check_against_matrix(image, {radius, 1, 10, 100});
  }
}

TEST_CASE("the forest finds the major nodes of the matrix form on 1,000 seeded skeletons") {
  for (unsigned seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    const Bits image = test::random_skeleton(seed);
    const DigestionParameters weights[] = {{5, 1, 10, 100}, {5, 1, 2, 3}, {3, 1, 10, 100}, {9, 0, 1, 100}};
    check_against_matrix(image, weights[seed % 4]);
  }
}

TEST_CASE("equal weights: the first pixel in raster order is the major node") {
  const Forest forest(test::bits({"######"}), {5, 1, 10, 100});
  REQUIRE(forest.result.major_nodes.size() == 1);
  CHECK(forest.result.major_nodes[0].at.x == 1);  // the end point has weight 0
  CHECK(forest.result.major_nodes[0].weight == 4);
}

TEST_CASE("a fork outweighs the line it stands in") {
  const Forest forest(tee, {5, 1, 10, 100});
  bool near_fork = false;
  for (const MajorNode& n : forest.result.major_nodes) {
    near_fork = near_fork || (n.weight >= 100 && n.at.x >= 9 && n.at.x <= 11 && n.at.y <= 2);
  }
  CHECK(near_fork);
}

TEST_CASE("the forest tells which major node every pixel of a line belongs to") {
  const Forest forest(test::drawn_x(), {5, 1, 10, 100});
  for (int i = 0; i < forest.index.size(); ++i) {
    const PixelIndex root = digestion_root(forest.memory.digestion.parent, static_cast<PixelIndex>(i));
    const GridPoint at = forest.index.pixel(root);
    bool is_major = false;
    for (const MajorNode& n : forest.result.major_nodes) is_major = is_major || (n.at.x == at.x && n.at.y == at.y);
    CHECK(is_major);
  }
}

TEST_CASE("major nodes lie farther apart than the radius") {
  const Bits image = test::random_skeleton(3);
  const Forest forest(image, {5, 1, 10, 100});
  const auto nodes = forest.result.major_nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const int dx = nodes[i].at.x - nodes[k].at.x;
      const int dy = nodes[i].at.y - nodes[k].at.y;
      CHECK(dx * dx + dy * dy > 25);
    }
  }
}

TEST_CASE("more skeleton than the memory holds: the lower rows are kept, the rest is counted") {
  Bits image(320, 240);
  for (int y = 0; y < 240; y += 2) {
    for (int x = 0; x < 320; ++x) image.view().set(x, y, true);
  }
  const Forest forest(image, {5, 1, 10, 100});
  CHECK(forest.index.size() == 12800);
  CHECK(forest.index.dropped() == 120 * 320 - 12800);
  CHECK(forest.index.pixels().front().y == 240 - 2 * 40);
  CHECK(forest.index.at(0, 0) == no_pixel);
  CHECK(forest.index.at(319, 238) == 12799);
}

TEST_CASE("no room for all major nodes: the rest is counted") {
  const Bits image = test::drawn_x();
  Forest forest(image, {5, 1, 10, 100});
  const std::size_t all = forest.result.major_nodes.size();
  REQUIRE(all > 2);
  DigestionMemory little = forest.memory.digestion;
  little.major_nodes = little.major_nodes.first(2);
  const DigestionResult result = digest(forest.index, {5, 1, 10, 100}, little);
  CHECK(result.major_nodes.size() == 2);
  CHECK(result.dropped == static_cast<int>(all) - 2);
}

TEST_CASE("a number for every pixel and the neighbours across a word boundary") {
  const Bits image = test::random_bits(200, 30, 20, 7);
  const Forest forest(image, {5, 1, 10, 100});
  for (int i = 0; i < forest.index.size(); ++i) {
    const GridPoint p = forest.index.pixel(static_cast<PixelIndex>(i));
    CHECK(forest.index.at(p.x, p.y) == i);
    unsigned expected = 0;
    for (int k = 0; k < 8; ++k) {
      if (image.view().get(p.x + neighbour_dx[k], p.y + neighbour_dy[k])) expected |= 1U << k;
    }
    CHECK(forest.index.neighbours(p) == expected);
  }
}

}  // namespace touchline
