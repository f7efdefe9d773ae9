// SPDX-License-Identifier: Apache-2.0
// Line candidates: white search united with Canny's edges (paper section IV-C). Reading: an edge counts when it has
// white on one side and green on the other; and, as white search, only where the white ends in green again within a
// line's width.
#pragma once

#include <array>
#include <cstdint>

#include "vision/green.h"
#include "vision/image/bit_image.h"
#include "vision/image/canny.h"
#include "vision/image/image_view.h"
#include "vision/image/kernels.h"
#include "vision/line_width_table.h"

namespace touchline {

/// Why a gap in the green or an edge is no candidate.
enum class CandidateRejection : std::uint8_t {
  gap_too_wide,        // wider than a line can look there
  gap_too_thin,        // narrower than half a line
  gap_not_white,       // less than half of its pixels are white
  gap_not_bright,      // not brighter than the green beside it: a shadow, a dark foot
  edge_without_white,  // no white beside it: the texture of the carpet, a shadow
  edge_without_green,  // no green beside it: clutter
  edge_of_wide,        // the white does not end within a line's width: floor, a board
  count,
};
const char* to_string(CandidateRejection reason);
inline constexpr std::size_t candidate_rejections = static_cast<std::size_t>(CandidateRejection::count);

/// Thresholds that noise of the measured strength passes rarely: 4 and 8 times its gradient.
CannyThresholds edge_thresholds(const CarpetModel& carpet);

struct EdgeInput {
  ImageView<const std::uint8_t> luma;
  ConstBitView edges;  // Canny's
  ConstBitView green;
  ConstBitView white;
  LineWidthView widths;
  Kernels kernels = portable_kernels();
};

/// Adds to `lines` the edges that bound a line, and the white between them. Counts the others by reason. Returns how
/// many were taken.
int add_line_edges(const EdgeInput& input, BitView lines, std::array<int, candidate_rejections>& rejected);

}  // namespace touchline
