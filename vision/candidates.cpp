// SPDX-License-Identifier: Apache-2.0
#include "vision/candidates.h"

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"
#include "vision/line_extent.h"

namespace touchline {
namespace {

constexpr int side_reach = 3;  // pixels from an edge to where the blur has ended

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

enum class EdgeVerdict : std::uint8_t { line, without_white, without_green, of_wide };

/// An edge pixel, and the step along the row or the column (whichever is nearer to the gradient) to its bright side.
struct Edge {
  int x, y;
  int dx, dy;
  int rise, run;  // slope of the edge against the scan's normal
};

Edge edge_at(ImageView<const std::uint8_t> luma, int x, int y) {
  const Gradient g = gradient_at(luma, x, y);
  if (magnitude(g.x) >= magnitude(g.y)) return {x, y, g.x >= 0 ? 1 : -1, 0, magnitude(g.y), magnitude(g.x)};
  return {x, y, 0, g.y >= 0 ? 1 : -1, magnitude(g.x), magnitude(g.y)};
}

/// `length` is set to the pixels from the edge to the green on the other side.
EdgeVerdict judge(const EdgeInput& input, const Edge& e, int& length) {
  bool green_behind = false;
  for (int k = 1; k <= side_reach; ++k) green_behind = green_behind || input.green.get(e.x - k * e.dx, e.y - k * e.dy);
  if (!green_behind) return EdgeVerdict::without_green;

  const LineWidth& width = width_at(input.widths, e.x, e.y);
  const int limit = with_tolerance(width.slanted) + side_reach;
  int white = 0;
  for (length = 1; length <= limit; ++length) {
    const int x = e.x + length * e.dx;
    const int y = e.y + length * e.dy;
    if (input.white.get(x, y)) {
      ++white;
    } else if (white == 0 && length >= side_reach) {
      return EdgeVerdict::without_white;
    } else if (white > 0 && input.green.get(x, y)) {
      break;
    }
  }
  if (white == 0) return EdgeVerdict::without_white;
  const std::uint16_t along = e.dx != 0 ? width.across_row : width.across_column;
  const std::uint16_t other = e.dx != 0 ? width.across_column : width.across_row;
  if (length > limit || wider_than_slope_allows(length, e.rise, e.run, along, other, width.slanted))
    return EdgeVerdict::of_wide;
  return EdgeVerdict::line;
}

/// The pixels from which one of the next `side_reach` in a direction is set, for 64 pixels of a row at once.
struct Near {
  BitWord left = 0, right = 0, above = 0, below = 0;
};
Near near_bits(ConstBitView mask, int y, int word) {
  Near near;
  const BitWord* row = mask.row(y);
  const BitWord before = word > 0 ? row[word - 1] : 0;
  const BitWord after = word + 1 < words_for(mask.width) ? row[word + 1] : 0;
  for (int k = 1; k <= side_reach; ++k) {
    near.left |= row[word] << k | before >> (bits_per_word - k);
    near.right |= row[word] >> k | after << (bits_per_word - k);
    if (y >= k) near.above |= mask.row(y - k)[word];
    if (y + k < mask.height) near.below |= mask.row(y + k)[word];
  }
  return near;
}

/// Of 64 edge pixels those whose verdict does not depend on the edge's direction: they are counted at once, for most
/// edges are the carpet's noise, and the rest is returned.
BitWord undecided(const EdgeInput& input, int y, int word, int& without_green, int& without_white) {
  const BitWord edges = input.edges.row(y)[word];
  if (edges == 0) return 0;
  const Near white = near_bits(input.white, y, word);
  const BitWord no_white = edges & ~(white.left | white.right | white.above | white.below);
  if (no_white == 0) return edges;
  const Near green = near_bits(input.green, y, word);
  const BitWord nowhere = no_white & ~(green.left | green.right | green.above | green.below);
  const BitWord everywhere = no_white & green.left & green.right & green.above & green.below;
  without_green += bits_set(nowhere);
  without_white += bits_set(everywhere);
  return edges & ~(nowhere | everywhere);
}

constexpr int zone_block_px = 8;

/// Of each byte that has a bit, all bits.
BitWord filled_bytes(BitWord word) {
  constexpr BitWord low = 0x7F7F7F7F7F7F7F7FU;
  const BitWord tops = (((word & low) + low) | word) & ~low;
  return tops | (tops - (tops >> 7));
}

/// Rows of blocks of 8x8 pixels, from the top: the blocks in which, or in whose eight neighbours, a mask has a pixel.
class NearBlocks {
 public:
  explicit NearBlocks(ConstBitView mask) : mask_(mask) { read(0, row(0)); }
  void next() {
    ++row_;
    read(row_ + 1, row(row_ + 1));
  }
  [[nodiscard]] BitWord word(int i) {
    const auto at = static_cast<std::size_t>(i);
    return row(row_ + 2)[at] | row(row_)[at] | row(row_ + 1)[at];
  }

 private:
  using Row = std::array<BitWord, words_for(max_mask_width)>;
  Row& row(int number) { return rows_[static_cast<std::size_t>(number % 3)]; }

  /// One row of blocks, grown by one on either side.
  void read(int number, Row& out) {
    const int words = words_for(mask_.width);
    Row any{};
    for (int y = number * zone_block_px; y < std::min((number + 1) * zone_block_px, mask_.height); ++y) {
      for (int i = 0; i < words; ++i) any[static_cast<std::size_t>(i)] |= mask_.row(y)[i];
    }
    BitWord before = 0;
    for (int i = 0; i < words; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const BitWord here = filled_bytes(any[at]);
      const BitWord after = i + 1 < words ? filled_bytes(any[at + 1]) : 0;
      out[at] = here | here << 8 | here >> 8 | before >> 56 | after << 56;
      before = here;
    }
  }

  ConstBitView mask_;
  int row_ = -1;  // in the middle of the three; the one above the first is empty
  std::array<Row, 3> rows_{};
};

}  // namespace

const char* to_string(CandidateRejection reason) {
  switch (reason) {
    case CandidateRejection::gap_too_wide: return "gap_too_wide";
    case CandidateRejection::gap_too_thin: return "gap_too_thin";
    case CandidateRejection::gap_not_white: return "gap_not_white";
    case CandidateRejection::gap_not_bright: return "gap_not_bright";
    case CandidateRejection::edge_without_white: return "edge_without_white";
    case CandidateRejection::edge_without_green: return "edge_without_green";
    case CandidateRejection::edge_of_wide: return "edge_of_wide";
    case CandidateRejection::count: break;
  }
  return "unknown reason";
}

CannyThresholds edge_thresholds(const CarpetModel& carpet) {
  // Binomial and Sobel give noise of sigma a gradient of 1.65 sigma; carpet.noise is in 1/16: 4 * 1.65 / 16 = 0.41.
  const int low = std::clamp<std::int32_t>(carpet.noise * 41 / 100, 12, 600);
  return {low, 2 * low};
}

void find_edge_zone(ConstBitView white, ConstBitView green, BitView zone) {
  assert(zone.width <= max_mask_width);
  const int words = words_for(zone.width);
  NearBlocks near_white(white), near_green(green);
  for (int y0 = 0; y0 < zone.height; y0 += zone_block_px) {
    near_white.next();
    near_green.next();
    for (int i = 0; i < words; ++i) {
      BitWord bits = near_white.word(i) & near_green.word(i);
      if (i == words - 1) bits &= last_word_mask(zone.width);
      for (int y = y0; y < std::min(y0 + zone_block_px, zone.height); ++y) zone.row(y)[i] = bits;
    }
  }
}

int add_line_edges(const EdgeInput& input, BitView lines, std::array<int, candidate_rejections>& rejected) {
  const auto count_rejection = [&rejected](CandidateRejection reason) { ++rejected[static_cast<std::size_t>(reason)]; };
  int taken = 0;
  const auto look = [&](int x, int y) {
    const Edge edge = edge_at(input.luma, x, y);
    int length = 0;
    switch (judge(input, edge, length)) {
      case EdgeVerdict::line:
        ++taken;
        // Where white search was already, the edge adds nothing but roughness.
        if (lines.get(x + edge.dx, y + edge.dy) || lines.get(x + 2 * edge.dx, y + 2 * edge.dy)) break;
        for (int k = 0; k < length; ++k) lines.set(x + k * edge.dx, y + k * edge.dy, true);
        break;
      case EdgeVerdict::without_white: count_rejection(CandidateRejection::edge_without_white); break;
      case EdgeVerdict::without_green: count_rejection(CandidateRejection::edge_without_green); break;
      case EdgeVerdict::of_wide: count_rejection(CandidateRejection::edge_of_wide); break;
    }
  };
  int& without_green = rejected[static_cast<std::size_t>(CandidateRejection::edge_without_green)];
  int& without_white = rejected[static_cast<std::size_t>(CandidateRejection::edge_without_white)];
  const int words = words_for(input.edges.width);
  for (int y = 0; y < input.edges.height; ++y) {
    for (int i = 0; i < words; ++i) {
      for_each_bit(undecided(input, y, i, without_green, without_white),
                   [&](int bit) { look(i * bits_per_word + bit, y); });
    }
  }
  return taken;
}

}  // namespace touchline
