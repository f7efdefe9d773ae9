// SPDX-License-Identifier: Apache-2.0
// Blobs, contours and growing against a plain flood fill.
#include "vision/image/blobs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

#include "tests/support/ascii_image.h"
#include "vision/image/bit_ops.h"
#include "vision/image/contour.h"
#include "vision/image/grow.h"

using namespace touchline;
using namespace touchline::test;

namespace {

/// The blob that holds (x, y), by a flood with an explicit list.
Bits flood(const Bits& mask, int x, int y) {
  Bits blob(mask.width, mask.height);
  std::vector<std::pair<int, int>> open = {{x, y}};
  while (!open.empty()) {
    const auto [cx, cy] = open.back();
    open.pop_back();
    if (!mask.view().get(cx, cy) || blob.view().get(cx, cy)) continue;
    blob.view().set(cx, cy, true);
    for (int d = 0; d < 9; ++d) open.emplace_back(cx + d % 3 - 1, cy + d / 3 - 1);
  }
  return blob;
}

std::vector<Blob> plain_blobs(Bits mask) {
  std::vector<Blob> blobs;
  for (int y = 0; y < mask.height; ++y) {
    for (int x = 0; x < mask.width; ++x) {
      if (!mask.view().get(x, y)) continue;
      const Bits pixels = flood(mask, x, y);
      Blob blob = {{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)}, 32767, -1, -1, 0};
      for_each_set_bit(pixels.view(), [&](int px, int py) {
        blob.left = std::min(blob.left, static_cast<std::int16_t>(px));
        blob.right = std::max(blob.right, static_cast<std::int16_t>(px));
        blob.bottom = std::max(blob.bottom, static_cast<std::int16_t>(py));
        ++blob.area;
      });
      and_not_with(mask.view(), pixels.view());
      blobs.push_back(blob);
    }
  }
  return blobs;
}

bool same(const Blob& a, const Blob& b) {
  return a.first == b.first && a.left == b.left && a.right == b.right && a.bottom == b.bottom && a.area == b.area;
}

/// Pixels of the blob that have a side in common with the outside (4-connected from beyond the border).
Bits outer_border(const Bits& blob) {
  const int w = blob.width + 2, h = blob.height + 2;
  Bits outside(w, h);
  std::vector<std::pair<int, int>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [x, y] = open.back();
    open.pop_back();
    if (x < 0 || y < 0 || x >= w || y >= h || outside.view().get(x, y) || blob.view().get(x - 1, y - 1)) continue;
    outside.view().set(x, y, true);
    for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) open.emplace_back(x + dx, y + dy);
  }
  Bits border(blob.width, blob.height);
  for_each_set_bit(blob.view(), [&](int x, int y) {
    const ConstBitView o = outside.view();
    if (o.get(x, y + 1) || o.get(x + 2, y + 1) || o.get(x + 1, y) || o.get(x + 1, y + 2)) border.view().set(x, y, true);
  });
  return border;
}

/// Draws the closed polyline; its sides run along rows, columns or diagonals.
Bits draw(const std::vector<GridPoint>& polyline, int w, int h) {
  Bits image(w, h);
  for (std::size_t i = 0; i < polyline.size(); ++i) {
    const GridPoint a = polyline[i], b = polyline[(i + 1) % polyline.size()];
    const int dx = b.x - a.x, dy = b.y - a.y, steps = std::max(std::abs(dx), std::abs(dy));
    CHECK((dx == 0 || dy == 0 || std::abs(dx) == std::abs(dy)));
    for (int s = 0; s <= steps; ++s) {
      image.view().set(a.x + (steps == 0 ? 0 : dx / steps * s), a.y + (steps == 0 ? 0 : dy / steps * s), true);
    }
  }
  return image;
}

struct Found {
  std::vector<Blob> blobs;
  int dropped = 0;
};
Found find(const Bits& mask, std::size_t capacity = 100000) {
  auto storage = std::make_unique<BlobStorage<640>>();
  Found found;
  found.blobs.resize(capacity);
  const BlobCount count = find_blobs(mask.view(), storage->memory(), found.blobs);
  found.blobs.resize(static_cast<std::size_t>(count.found));
  found.dropped = count.dropped;
  return found;
}

}  // namespace

TEST_CASE("blobs are those of a flood fill, at every size and density") {
  unsigned seed = 0;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {10, 30, 45, 60, 95}) {
      const Bits mask = random_bits(w, h * 3, percent, ++seed);
      std::vector<Blob> expected = plain_blobs(mask);
      std::vector<Blob> found = find(mask).blobs;
      std::sort(found.begin(), found.end(), [](const Blob& a, const Blob& b) {
        return std::pair(a.first.y, a.first.x) < std::pair(b.first.y, b.first.x);
      });
      REQUIRE(found.size() == expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) CHECK(same(found[i], expected[i]));
    }
  }
}

TEST_CASE("touching corners join, and a U becomes one blob at its bottom") {
  const Found found = find(bits({"#..#...", ".##....", "......#", "#...#.#", "#...#..", "#####.."}));
  REQUIRE(found.blobs.size() == 3);
  const Blob u = found.blobs[static_cast<std::size_t>(largest_blob(found.blobs))];
  CHECK(u.area == 9);
  CHECK(u.first == GridPoint{0, 3});
  CHECK(u.right == 4);
  CHECK(u.bottom == 5);
}

TEST_CASE("noise cannot take the large blob's place; what is dropped is counted") {
  Bits mask(320, 240);
  for (int y = 0; y < 100; y += 2) {
    for (int x = 0; x < 320; x += 2) mask.view().set(x, y, true);
  }
  for (int y = 120; y < 160; ++y) set_span(mask.view(), y, 20, 99, true);
  for (int y = 180; y < 240; y += 2) {
    for (int x = 0; x < 320; x += 2) mask.view().set(x, y, true);
  }
  const Found found = find(mask, 4);
  CHECK(found.dropped == 160 * 80 + 1 - 4);
  REQUIRE(found.blobs.size() == 4);
  CHECK(found.blobs[static_cast<std::size_t>(largest_blob(found.blobs))].area == 40 * 80);
}

TEST_CASE("of equal blobs the first in raster order is the largest; of none there is none") {
  const Found found = find(bits({"....#", "##...", "....#"}));
  CHECK(largest_blob(find(bits({"..##.", ".....", "##..."})).blobs) == 0);
  CHECK(found.blobs[static_cast<std::size_t>(largest_blob(found.blobs))].first == GridPoint{0, 1});
  CHECK(largest_blob({}) == -1);
}

TEST_CASE("a contour is the blob's outer border: random blobs") {
  std::vector<GridPoint> points(20000);
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Bits mask = random_bits(30 + static_cast<int>(seed), 20, 20 + static_cast<int>(seed), seed);
    for (const Blob& blob : plain_blobs(mask)) {
      const Bits pixels = flood(mask, blob.first.x, blob.first.y);
      const Contour contour = trace_contour(mask.view(), blob.first, points);
      REQUIRE(contour.dropped == 0);
      CHECK(points[0] == blob.first);
      const std::vector<GridPoint> polyline(points.begin(), points.begin() + contour.points);
      REQUIRE(ascii(draw(polyline, mask.width, mask.height)) == ascii(outer_border(pixels)));
    }
  }
}

TEST_CASE("contours of drawn shapes: corners only, counter-clockwise; a hole is not followed") {
  std::vector<GridPoint> points(16);
  const auto trace = [&](const std::vector<std::string_view>& rows, GridPoint first) {
    const Contour contour = trace_contour(bits(rows).view(), first, points);
    return std::vector<GridPoint>(points.begin(), points.begin() + contour.points);
  };
  CHECK(trace({".....", ".###.", ".#.#.", ".###."}, {1, 1}) == std::vector<GridPoint>{{1, 1}, {1, 3}, {3, 3}, {3, 1}});
  CHECK(trace({"#"}, {0, 0}) == std::vector<GridPoint>{{0, 0}});
  CHECK(trace({"###"}, {0, 0}) == std::vector<GridPoint>{{0, 0}, {2, 0}});
  CHECK(trace({"..#", ".#.", "#.."}, {2, 0}) == std::vector<GridPoint>{{2, 0}, {0, 2}});
}

TEST_CASE("a contour that finds no room counts what it drops and still ends") {
  const Bits mask = random_bits(64, 64, 70, 9);
  std::vector<GridPoint> all(20000), few(5);
  const GridPoint first = plain_blobs(mask)[0].first;
  const Contour whole = trace_contour(mask.view(), first, all);
  const Contour part = trace_contour(mask.view(), first, few);
  CHECK(part.points == 5);
  CHECK(part.dropped == whole.points - 5);
  CHECK(part.length == whole.length);
  CHECK(trace_contour(mask.view(), first, {}).dropped == whole.points);
}

TEST_CASE("growing fills exactly the blobs that hold a seed") {
  unsigned seed = 100;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {20, 40, 60, 90}) {
      const Bits mask = random_bits(w, h * 3, percent, ++seed);
      Bits seeds = random_bits(w, h * 3, 2, ++seed);
      Bits expected(w, h * 3);
      for_each_set_bit(seeds.view(), [&](int x, int y) { or_with(expected.view(), flood(mask, x, y).view()); });
      CHECK(grow_inside(seeds.view(), mask.view()).finished);
      REQUIRE(ascii(seeds) == ascii(expected));
      CHECK(padding_is_clear(seeds.view()));
    }
  }
}

TEST_CASE("growing follows a winding path to its end") {
  const Bits path = bits({"#########", "........#", "#######.#", "#.....#.#", "#.###.#.#", "#.#...#.#", "#.#####.#",
                          "#.......#", "#########"});
  Bits seeds(9, 9);
  seeds.view().set(0, 0, true);
  const GrowResult result = grow_inside(seeds.view(), path.view());
  CHECK(result.finished);
  CHECK(seeds == path);
}

TEST_CASE("one blob is cut out of a mask, by taking the others off or by growing") {
  unsigned seed = 900;
  for (const auto& [w, h] : awkward_sizes()) {
    for (const int percent : {5, 20, 40, 60, 90}) {
      const Bits mask = random_bits(w, h * 3, percent, ++seed);
      const std::vector<Blob> blobs = plain_blobs(mask);
      for (std::size_t kept = 0; kept < blobs.size(); kept += 1 + blobs.size() / 5) {
        const std::string expected = ascii(flood(mask, blobs[kept].first.x, blobs[kept].first.y));
        for (const bool all : {true, false}) {
          Bits field = random_bits(w, h * 3, 50, ++seed);
          Bits scratch(w, h * 3);
          cut_out(mask.view(), blobs, kept, all, field.view(), scratch.view());
          REQUIRE(ascii(field) == expected);
          CHECK(padding_is_clear(field.view()));
          CHECK(count(scratch.view()) == 0);
        }
      }
    }
  }
}
