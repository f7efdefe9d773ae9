// SPDX-License-Identifier: Apache-2.0
#include "vision/candidates.h"

#include <algorithm>

namespace touchline {
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

}  // namespace touchline
