// SPDX-License-Identifier: Apache-2.0
// Which of Canny's edges bound a line: 64 pixels at once as far as neighbours decide, and by the step to the line's
// other side for the rest.
#include <algorithm>
#include <bit>
#include <cstddef>

#include "vision/candidates.h"
#include "vision/image/bit_ops.h"
#include "vision/line_extent.h"

namespace touchline {
namespace {

constexpr int magnitude(int v) { return v < 0 ? -v : v; }

struct Gradient {
  int x = 0, y = 0;
};
/// Sobel, at the border with the outermost pixels repeated.
Gradient gradient_at(ImageView<const std::uint8_t> luma, int x, int y) {
  const int left = std::max(x - 1, 0);
  const int right = std::min(x + 1, luma.width - 1);
  const std::uint8_t* above = luma.row(std::max(y - 1, 0));
  const std::uint8_t* here = luma.row(y);
  const std::uint8_t* below = luma.row(std::min(y + 1, luma.height - 1));
  return {above[right] + 2 * here[right] + below[right] - above[left] - 2 * here[left] - below[left],
          below[left] + 2 * below[x] + below[right] - above[left] - 2 * above[x] - above[right]};
}

/// 64 pixels of a row.
struct Place {
  int y = 0;
  int word = 0;
  [[nodiscard]] int x(int bit) const { return word * bits_per_word + bit; }
};

/// Pixels by the step along the row or the column (whichever is nearer to their gradient) that leads to their bright
/// side.
struct Steps {
  BitWord left = 0, right = 0, above = 0, below = 0;
};
Steps operator&(const Steps& a, const Steps& b) {
  return {a.left & b.left, a.right & b.right, a.above & b.above, a.below & b.below};
}
Steps operator&(const Steps& a, BitWord b) { return {a.left & b, a.right & b, a.above & b, a.below & b}; }
BitWord any(const Steps& s) { return s.left | s.right | s.above | s.below; }
BitWord every(const Steps& s) { return s.left & s.right & s.above & s.below; }
Steps reversed(const Steps& s) { return {s.right, s.left, s.below, s.above}; }

/// The pixels from which one of the next Reach in a direction is set.
template <int Reach>
Steps near_bits(ConstBitView mask, const Place& at) {
  Steps near;
  const BitWord* row = mask.row(at.y) + at.word;
  const BitWord here = row[0];
  const BitWord before = at.word > 0 ? row[-1] : 0;
  const BitWord after = at.word + 1 < words_for(mask.width) ? row[1] : 0;
  for (int k = 1; k <= Reach; ++k) {
    near.left |= here << k | before >> (bits_per_word - k);
    near.right |= here >> k | after << (bits_per_word - k);
  }
  const std::ptrdiff_t stride = mask.stride;
  if (at.y >= Reach && at.y + Reach < mask.height) {
    for (int k = 1; k <= Reach; ++k) {
      near.above |= row[-k * stride];
      near.below |= row[k * stride];
    }
    return near;
  }
  for (int k = 1; k <= Reach; ++k) {
    if (at.y >= k) near.above |= row[-k * stride];
    if (at.y + k < mask.height) near.below |= row[k * stride];
  }
  return near;
}

Steps steps_to_bright_side(const EdgeInput& input, const Place& at, BitWord edges) {
  const ImageView<const std::uint8_t>& luma = input.luma;
  EdgeDirections d;
  if (input.kernels.edges.directions != nullptr) {
    const EdgeLuma rows = {luma.row(std::max(at.y - 1, 0)), luma.row(at.y),
                           luma.row(std::min(at.y + 1, luma.height - 1)), luma.width};
    d = input.kernels.edges.directions(rows, at.x(0), edges);
  } else {
    for_each_bit(edges, [&](int bit) {
      const Gradient g = gradient_at(luma, at.x(bit), at.y);
      const BitWord flag = BitWord{1} << bit;
      if (magnitude(g.x) >= magnitude(g.y)) d.along_row |= flag;
      if (g.x >= 0) d.right |= flag;
      if (g.y >= 0) d.below |= flag;
    });
  }
  const BitWord along_row = edges & d.along_row;
  const BitWord along_column = edges & ~d.along_row;
  return {along_row & ~d.right, along_row & d.right, along_column & ~d.below, along_column & d.below};
}

struct Edge {
  int x, y;
  int dx, dy;  // to the bright side
};

/// Pixels from the edge to the green behind the white; limit + 1 when that is farther.
int step_to_green(const EdgeInput& input, const Edge& e, int limit) {
  bool seen = false;
  for (int length = 1; length <= limit; ++length) {
    const int x = e.x + length * e.dx;
    const int y = e.y + length * e.dy;
    const bool white = input.white.get(x, y);
    if (seen && !white && input.green.get(x, y)) return length;
    seen = seen || white;
  }
  return limit + 1;
}

/// Whether a line can be as wide as that.
bool fits(const EdgeInput& input, const Edge& e, int length, const LineWidth& width) {
  const std::uint16_t along = e.dx != 0 ? width.across_row : width.across_column;
  const std::uint16_t other = e.dx != 0 ? width.across_column : width.across_row;
  const ExtentBySlope extent(length, along, other, width.slanted);
  if (extent.never_wider()) return true;
  if (extent.always_wider()) return false;
  const Gradient g = gradient_at(input.luma, e.x, e.y);
  const int rise = e.dx != 0 ? magnitude(g.y) : magnitude(g.x);  // slope of the edge against the scan's normal
  const int run = e.dx != 0 ? magnitude(g.x) : magnitude(g.y);
  return !extent.wider_at(rise, run);
}

/// The 64 pixels to the right of a pixel, the nearest first, or to the left, the nearest last.
BitWord next_pixels(ConstBitView mask, const Place& at, int bit) {
  const BitWord* row = mask.row(at.y);
  const BitWord after = at.word + 1 < words_for(mask.width) ? row[at.word + 1] : 0;
  return row[at.word] >> bit >> 1 | after << (bits_per_word - 1 - bit);
}
BitWord previous_pixels(ConstBitView mask, const Place& at, int bit) {
  const BitWord* row = mask.row(at.y);
  const BitWord before = at.word > 0 ? row[at.word - 1] : 0;
  return row[at.word] << (bits_per_word - 1 - bit) << 1 | before >> bit;
}

/// Of the edges with white ahead in their row those that bound a line.
BitWord lines_in_row(const EdgeInput& input, const Place& at, BitWord edges, int dx) {
  BitWord lines = 0;
  for_each_bit(edges, [&](int bit) {
    const Edge e = {at.x(bit), at.y, dx, 0};
    const LineWidth& width = width_at(input.widths, e.x, e.y);
    const int limit = longest_step(width);
    int length = limit + 1;
    if (limit > bits_per_word) {
      length = step_to_green(input, e, limit);
    } else if (dx > 0) {
      const BitWord white = next_pixels(input.white, at, bit);
      const BitWord stop = next_pixels(input.green, at, bit) & ~white & (~BitWord{0} << std::countr_zero(white));
      if (stop != 0) length = std::countr_zero(stop) + 1;
    } else {
      const BitWord white = previous_pixels(input.white, at, bit);
      const BitWord stop = previous_pixels(input.green, at, bit) & ~white & (~BitWord{0} >> std::countl_zero(white));
      if (stop != 0) length = std::countl_zero(stop) + 1;
    }
    if (length <= limit && fits(input, e, length, width)) lines |= BitWord{1} << bit;
  });
  return lines;
}

/// The same in their columns, all of them at once.
BitWord lines_in_columns(const EdgeInput& input, const Place& at, BitWord edges, int dy) {
  const int limit = longest_step(input.widths, at.y, at.word, edges);
  BitWord lines = 0;
  BitWord seen = 0;
  for (int length = 1; length <= limit && edges != 0; ++length) {
    const int y = at.y + length * dy;
    if (y < 0 || y >= input.white.height) break;
    const BitWord white = input.white.row(y)[at.word];
    const BitWord ends = edges & seen & ~white & input.green.row(y)[at.word];
    seen |= white;
    edges &= ~ends;
    for_each_bit(ends, [&](int bit) {
      const Edge e = {at.x(bit), at.y, 0, dy};
      const LineWidth& width = width_at(input.widths, e.x, e.y);
      if (length <= longest_step(width) && fits(input, e, length, width)) lines |= BitWord{1} << bit;
    });
  }
  return lines;
}

/// Sets an edge and the white behind it, unless white search was there already: then the edge adds nothing but
/// roughness.
void add_edge(const EdgeInput& input, const Edge& e, BitView lines) {
  if (lines.get(e.x + e.dx, e.y + e.dy) || lines.get(e.x + 2 * e.dx, e.y + 2 * e.dy)) return;
  const int length = step_to_green(input, e, longest_step(width_at(input.widths, e.x, e.y)));
  for (int k = 0; k < length; ++k) lines.set(e.x + k * e.dx, e.y + k * e.dy, true);
}

struct EdgeCounts {
  int taken = 0, without_green = 0, without_white = 0, of_wide = 0;
};

void add_edges_of_word(const EdgeInput& input, const Place& at, BitWord edges, BitView lines, EdgeCounts& counts) {
  const Steps white = near_bits<edge_side_px>(input.white, at);
  const Steps green = near_bits<edge_side_px>(input.green, at);
  // Most edges are the carpet's noise, and need no direction: without green anywhere, or without white and green on all
  // sides.
  const BitWord no_white = edges & ~any(white);
  const BitWord nowhere = no_white & ~any(green);
  const BitWord everywhere = no_white & every(green);
  const BitWord left = edges & ~(nowhere | everywhere);
  const Steps steps = left != 0 ? steps_to_bright_side(input, at, left) : Steps{};
  const BitWord on_green = any(steps & reversed(green));
  const BitWord before_white = on_green & any(steps & white);
  counts.without_green += bits_set_in_one(nowhere | (left & ~on_green));
  counts.without_white += bits_set_in_one(everywhere | (on_green & ~before_white));
  if (before_white == 0) return;

  const Steps bounds = steps & before_white;
  const Steps found = {lines_in_row(input, at, bounds.left, -1), lines_in_row(input, at, bounds.right, 1),
                       lines_in_columns(input, at, bounds.above, -1), lines_in_columns(input, at, bounds.below, 1)};
  const BitWord taken = any(found);
  counts.taken += bits_set_in_one(taken);
  counts.of_wide += bits_set_in_one(before_white & ~taken);
  // What is added changes what the next ones see.
  for_each_bit(taken & ~any(found & near_bits<2>(lines, at)), [&](int bit) {
    const BitWord flag = BitWord{1} << bit;
    const int dx = (found.right & flag) != 0 ? 1 : (found.left & flag) != 0 ? -1 : 0;
    const int dy = (found.below & flag) != 0 ? 1 : (found.above & flag) != 0 ? -1 : 0;
    add_edge(input, {at.x(bit), at.y, dx, dy}, lines);
  });
}

}  // namespace

int add_line_edges(const EdgeInput& input, BitView lines, std::array<int, candidate_rejections>& rejected) {
  EdgeCounts counts;
  const int words = words_for(input.edges.width);
  for (int y = 0; y < input.edges.height; ++y) {
    for (int i = 0; i < words; ++i) {
      const BitWord edges = input.edges.row(y)[i];
      if (edges != 0) add_edges_of_word(input, {y, i}, edges, lines, counts);
    }
  }
  const auto count_rejections = [&rejected](CandidateRejection reason, int number) {
    rejected[static_cast<std::size_t>(reason)] += number;
  };
  count_rejections(CandidateRejection::edge_without_white, counts.without_white);
  count_rejections(CandidateRejection::edge_without_green, counts.without_green);
  count_rejections(CandidateRejection::edge_of_wide, counts.of_wide);
  return counts.taken;
}

}  // namespace touchline
