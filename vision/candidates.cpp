// SPDX-License-Identifier: Apache-2.0
#include "vision/candidates.h"

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

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

}  // namespace touchline
