// SPDX-License-Identifier: Apache-2.0
// Goal posts by colour, the paper's second landmark (Table II).
//
// A post is a vertical pole: whatever the lens does, all its points are seen at one azimuth about the camera's vertical
// axis, from its foot below the horizon up to beyond it. So the pixels of the post's colour are sorted by azimuth and
// elevation, and a post is a few azimuths beside each other with an unbroken column that begins on the carpet at a
// distance where a post looks as wide as these azimuths are, and goes up as high as a post. A poster does not begin on
// the carpet, a chair or a person is not as wide as a post at its distance, and a foot that is hidden has no carpet
// before it.
#pragma once

#include <array>
#include <cstdint>

#include "vision/features.h"
#include "vision/line_segments.h"
#include "vision/work_rays.h"

namespace touchline {

struct PostParameters {
  float diameter_m = 0.10F;
  float max_range_m = 6.0F;
};

inline constexpr int post_bins = 480;   // 0.75 degrees of azimuth each, a little more than a working pixel
inline constexpr int post_levels = 64;  // of elevation, one bit each: 2 degrees

/// Working memory, by azimuth.
struct PostWork {
  std::array<std::uint64_t, post_bins> levels{};  // bit 0 is the lowest elevation
  std::array<float, post_bins> depression{};      // of the lowest pixel, radians below the horizon
};

/// `colour` has the pixels of the posts' colour. Fills `posts`; returns how many found no room.
int find_posts(ConstBitView colour, const WorkRays& rays, const FieldView& field, const PostParameters& parameters,
               PostWork& work, StaticVector<PostObservation, max_posts>& posts);

}  // namespace touchline
