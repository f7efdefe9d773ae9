// SPDX-License-Identifier: Apache-2.0
// The edges that bound a line, 64 at once and with every table of kernels, against the rule pixel by pixel.
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "vision/candidates.h"
#include "vision/image/bit_ops.h"
#include "vision/line_extent.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Scene {
  Gray luma;
  Bits edges, green, white;
  Samples<LineWidth> widths;
  [[nodiscard]] EdgeInput input(const Kernels& kernels) const {
    return {luma.view(), edges.view(), green.view(), white.view(), widths.view(), kernels};
  }
};

/// Spots of green and white some pixels across, so that runs of all lengths and both in one pixel occur.
Scene random_scene(int w, int h, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&random](int end) { return static_cast<int>(random() % static_cast<unsigned>(end)); };
  Scene s{Gray(w, h), random_bits(w, h, 20, seed), Bits(w, h), Bits(w, h),
          Samples<LineWidth>((w + 7) / 8, (h + 7) / 8)};
  for (std::uint8_t& v : s.luma.samples) v = static_cast<std::uint8_t>(below(seed % 2 == 0 ? 4 : 256));
  for (int spots = 0; spots < w * h / 24; ++spots) {
    Bits& mask = below(2) == 0 ? s.green : s.white;
    const int x = below(w), y = below(h), right = x + below(5), bottom = y + below(4);
    for (int v = y; v < std::min(bottom + 1, h); ++v) set_span(mask.view(), v, x, right, true);
  }
  for (LineWidth& width : s.widths.samples) {
    const int across = below(150), other = below(150);
    const int slanted = below(8) == 0 ? 0 : below(20) == 0 ? 1500 : std::max(across, other) + below(90);
    width = {static_cast<std::uint16_t>(across), static_cast<std::uint16_t>(other),
             static_cast<std::uint16_t>(slanted)};
  }
  return s;
}

struct Outcome {
  Bits lines;
  int taken = 0;
  std::array<int, candidate_rejections> rejected{};
};

class PlainRule {
 public:
  PlainRule(const Scene& scene, Outcome& out) : s_(scene), out_(out) {}
  void look(int x, int y) {
    const int gx = sobel(x, y, 1, 0), gy = sobel(x, y, 0, 1);
    const bool along_row = std::abs(gx) >= std::abs(gy);
    const int dx = along_row ? (gx >= 0 ? 1 : -1) : 0;
    const int dy = along_row ? 0 : (gy >= 0 ? 1 : -1);
    const auto green = [&](int k) { return s_.green.view().get(x + k * dx, y + k * dy); };
    const auto white = [&](int k) { return s_.white.view().get(x + k * dx, y + k * dy); };
    if (!green(-1) && !green(-2) && !green(-3)) return reject(CandidateRejection::edge_without_green);
    if (!white(1) && !white(2) && !white(3)) return reject(CandidateRejection::edge_without_white);
    const LineWidth& width = width_at(s_.widths.view(), x, y);
    const int limit = with_tolerance(width.slanted) + 3;
    int length = 1;
    for (bool seen = false; length <= limit; ++length) {
      if (seen && green(length) && !white(length)) break;
      seen = seen || white(length);
    }
    const auto across = along_row ? width.across_row : width.across_column;
    const auto other = along_row ? width.across_column : width.across_row;
    const int rise = std::min(std::abs(gx), std::abs(gy)), run = std::max(std::abs(gx), std::abs(gy));
    if (length > limit || wider_than_slope_allows(length, rise, run, across, other, width.slanted)) {
      return reject(CandidateRejection::edge_of_wide);
    }
    ++out_.taken;
    const BitView lines = out_.lines.view();
    if (lines.get(x + dx, y + dy) || lines.get(x + 2 * dx, y + 2 * dy)) return;
    for (int k = 0; k < length; ++k) lines.set(x + k * dx, y + k * dy, true);
  }

 private:
  void reject(CandidateRejection reason) { ++out_.rejected[static_cast<std::size_t>(reason)]; }
  /// Along the row (1, 0) or the column (0, 1); the border repeats.
  [[nodiscard]] int sobel(int x, int y, int ax, int ay) const {
    const auto luma = [this](int u, int v) {
      return int{s_.luma.view().at(std::clamp(u, 0, s_.luma.width - 1), std::clamp(v, 0, s_.luma.height - 1))};
    };
    int sum = 0;
    for (int k = -1; k <= 1; ++k) {
      const int weight = k == 0 ? 2 : 1;
      sum += weight * (luma(x + ax + k * ay, y + ay + k * ax) - luma(x - ax + k * ay, y - ay + k * ax));
    }
    return sum;
  }

  const Scene& s_;
  Outcome& out_;
};

}  // namespace

TEST_CASE("edges that bound a line are those of the rule, with every table of kernels") {
  unsigned seed = 0;
  int taken = 0;
  for (const auto& [w, h] : {std::pair{1, 1}, {7, 9}, {63, 20}, {64, 20}, {65, 20}, {83, 40}, {200, 60}, {320, 30}}) {
    for (int again = 0; again < 4; ++again) {
      const Scene scene = random_scene(w, h, ++seed);
      const Bits before = random_bits(w, h, 3, seed + 100);
      Outcome plain{before};
      PlainRule rule(scene, plain);
      for_each_set_bit(scene.edges.view(), [&](int x, int y) { rule.look(x, y); });
      taken += plain.taken;
      for (const Kernels& kernels : test::all_tables()) {
        CAPTURE(kernels.name);
        CAPTURE(seed);
        Outcome out{before};
        out.taken = add_line_edges(scene.input(kernels), out.lines.view(), out.rejected);
        REQUIRE(ascii(out.lines) == ascii(plain.lines));
        REQUIRE(out.rejected == plain.rejected);
        REQUIRE(out.taken == plain.taken);
      }
    }
  }
  CHECK(taken > 300);  // not all of them by way of rejection
}
