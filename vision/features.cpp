// SPDX-License-Identifier: Apache-2.0
// Names of junction types and of the reasons why a candidate is none.
#include "vision/features.h"

namespace touchline {

const char* to_string(JunctionType type) {
  switch (type) {
    case JunctionType::l: return "L";
    case JunctionType::t: return "T";
    case JunctionType::x: return "X";
  }
  return "unknown type";
}

const char* to_string(JunctionRejection reason) {
  switch (reason) {
    case JunctionRejection::none: return "none";
    case JunctionRejection::no_ground: return "no_ground";
    case JunctionRejection::too_far: return "too_far";
    case JunctionRejection::straight: return "straight";
    case JunctionRejection::curved: return "curved";
    case JunctionRejection::branch_too_short: return "branch_too_short";
    case JunctionRejection::bad_angles: return "bad_angles";
    case JunctionRejection::too_many_branches: return "too_many_branches";
    case JunctionRejection::at_border: return "at_border";
    case JunctionRejection::bridge: return "bridge";
    case JunctionRejection::duplicate: return "duplicate";
  }
  return "unknown reason";
}

}  // namespace touchline
