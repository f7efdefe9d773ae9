// SPDX-License-Identifier: Apache-2.0
// Junctions of a frame checked against the field, once the pose is sure: the validation of paper section V-A, in both
// directions. What vision reports where the field has no such junction is turned down; where the field has one whose
// branches are in the picture, it is reported, also when the node graph lost it (at the lens's rim, or where lines far
// away melt into one). Localization does not use the result, so that no pose confirms itself.
#pragma once

#include <cstdint>

#include "loc/field.h"
#include "loc/pose_estimate.h"
#include "platform/core/static_vector.h"
#include "vision/vision_result.h"

namespace touchline {

enum class JunctionSource : std::uint8_t {
  picture,  // found by vision; no sure pose to check it with
  both,     // found by vision, and the field has it there
  map,      // the field has it there, and all of its branches were found in the line mask
};
/// "picture", "both" or "map".
const char* to_string(JunctionSource source);

struct KnownJunction {
  Junction junction;  // of `both` and `map`: place, branches and covariance as the field and the pose have them
  JunctionSource source = JunctionSource::picture;
};

struct KnownJunctions {
  StaticVector<KnownJunction, max_junctions> list;  // at most as many as the field has, or as vision reports
  int turned_down = 0;                              // reported by vision where the field has no such junction
};

/// `sure` is the certainty() from which a pose counts (LocalizerConfig::confident). Without a sure pose all that vision
/// reports is passed on.
void check_junctions(const Field& field, const VisionResult& vision, const PoseEstimate& estimate, float sure,
                     KnownJunctions& out);

}  // namespace touchline
