// SPDX-License-Identifier: Apache-2.0
// Where could the robot be, judged by this frame alone? 200 uniform particles are too thin to find a pose in one
// frame; these poses are drawn from what is seen: oriented junctions, the circle, and a search over a grid of positions
// at the orientations that the lines' directions leave open.
#pragma once

#include "loc/full_likelihood.h"
#include "platform/core/static_vector.h"

namespace touchline {

enum class CandidateSource : std::uint8_t { junction, circle, grid };
struct PoseCandidate {
  Pose2 pose;
  float score = 0.0F;    // nats, <= 0: coarse likelihood
  float missing = 0.0F;  // nats that lines missing from the picture cost; the caller's to fill
  CandidateSource source = CandidateSource::grid;
};

inline constexpr std::size_t max_pose_candidates = 32;  // several times the poses that a field's symmetries leave open
using CandidateList = StaticVector<PoseCandidate, max_pose_candidates>;

/// The best candidates, best first, no two within 0.35 m and 20 degrees of each other. Empty when nothing is seen.
void find_candidates(const Field& field, const DistanceField& map, const Observation& observation,
                     const LocalizerConfig& config, const YawEvidence& yaw, CandidateList& out);

}  // namespace touchline
