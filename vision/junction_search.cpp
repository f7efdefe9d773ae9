// SPDX-License-Identifier: Apache-2.0
#include "vision/junction_search.h"

#include "vision/junction_errors.h"

namespace touchline {

void reject_junction(const JunctionSearch& search, const JunctionCandidate& c, int branches, JunctionRejection reason) {
  RejectedJunction r;
  (void)search.rays.projection().pixel(c.ground, r.pixel);
  r.branches = static_cast<std::uint8_t>(branches);
  r.reason = reason;
  search.features.rejections.push_back(r);
}

void accept_junction(const JunctionSearch& search, const JunctionCandidate& c, JunctionType type,
                     const float* directions, int count, float quality) {
  Junction j;
  if (!search.rays.projection().pixel(c.ground, j.pixel))
    return reject_junction(search, c, count, JunctionRejection::no_ground);
  j.type = type;
  j.ground = c.ground;
  j.covariance = search.rays.projection().ground_covariance(j.pixel, junction_sigma_px, junction_sigma_tilt);
  j.branches = count;
  for (int i = 0; i < count; ++i) j.direction[static_cast<std::size_t>(i)] = directions[i];
  const CameraPose& pose = search.rays.projection().pose();
  const float range = ground_distance(c.ground, {pose.x, pose.y});
  const float near_enough = math::clamp(1.25F - 0.25F * range, 0.3F, 1.0F);  // 1 up to 1 m, 0.5 at 3 m
  const float sure = math::clamp(1.2F - 0.2F * c.sigma, 0.3F, 1.0F);
  j.confidence = quality * near_enough * sure;
  search.features.junctions.push_back(j);
}

}  // namespace touchline
