// SPDX-License-Identifier: Apache-2.0
#include "vision/candidates.h"

#include <algorithm>

#include "vision/image/bit_ops.h"
#include "vision/image/morphology.h"

namespace touchline {
namespace {

constexpr int zone_px = 4;

/// The pixels of a word in whose row, or the one above or below, a mask has a pixel in the same or the next column.
BitWord beside(ConstBitView mask, int y, int i) {
  const int words = words_for(mask.width);
  BitWord here = 0, before = 0, after = 0;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, mask.height - 1); ++v) {
    const BitWord* row = mask.row(v);
    here |= row[i];
    if (i > 0) before |= row[i - 1];
    if (i + 1 < words) after |= row[i + 1];
  }
  return here | here << 1 | here >> 1 | before >> (bits_per_word - 1) | after << (bits_per_word - 1);
}

/// Adds to a mask all that lies within zone_px of the pixels of a word.
void add_surroundings(BitWord word, int y, int i, BitView mask) {
  BitWord here = word | word << 1 | word >> 1;
  here |= here << 1 | here >> 1;
  here |= here << 2 | here >> 2;
  BitWord left = 0, right = 0;  // what lies in the words beside it
  for (int k = 1; k <= zone_px; ++k) {
    left |= word << (bits_per_word - k);
    right |= word >> (bits_per_word - k);
  }
  const bool has_left = left != 0 && i > 0;
  const bool has_right = right != 0 && i + 1 < words_for(mask.width);
  for (int v = std::max(y - zone_px, 0); v <= std::min(y + zone_px, mask.height - 1); ++v) {
    BitWord* row = mask.row(v);
    row[i] |= here;
    if (has_left) row[i - 1] |= left;
    if (has_right) row[i + 1] |= right;
  }
}

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

void find_edge_zone(ConstBitView white, ConstBitView region, ConstBitView lines, BitView zone, const Kernels& kernels) {
  if (kernels.join_squares != nullptr) {  // whole rows, whatever is in them
    copy(lines, zone);
    dilate(zone, 3, kernels.join_squares);
    invert(zone);
    and_with(zone, white);
    and_with(zone, region);
    dilate(zone, 2 * zone_px + 1, kernels.join_squares);
    and_with(zone, region);
    return;
  }
  clear(zone);
  for (int y = 0; y < zone.height; ++y) {
    for (int i = 0; i < words_for(zone.width); ++i) {
      const BitWord word = white.row(y)[i] & region.row(y)[i];
      if (word == 0) continue;
      const BitWord open = word & ~beside(lines, y, i);
      if (open != 0) add_surroundings(open, y, i, zone);
    }
  }
  and_with(zone, region);
}

}  // namespace touchline
