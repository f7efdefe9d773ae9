// SPDX-License-Identifier: Apache-2.0
// Where the particles agree. The pose is that of one cluster, never a mean over two modes.
#pragma once

#include <array>

#include "loc/particles.h"
#include "loc/pose_estimate.h"
#include "platform/core/static_vector.h"

namespace touchline {

struct Cluster {
  Pose2 mean;
  PoseCovariance covariance;  // spread of its particles
  float mass = 0.0F;          // share of all weight, [0, 1]
  int count = 0;
};

inline constexpr std::size_t max_clusters =
    24;  // a lone corner fits a dozen places of a field, and their mirror images
using ClusterList = StaticVector<Cluster, max_clusters>;
inline constexpr std::uint8_t no_cluster = 255;
using ClusterIndex = std::array<std::uint8_t, max_particles>;  // of each particle

/// Greedy: the heaviest particle not yet taken gathers all within `radius` metres and `angle` radians of it, and then
/// of their mean; heaviest cluster first. Log weights are normalised as a side effect. O(particles x clusters).
/// `scratch` has room for a number of each particle.
void find_clusters(ParticleView particles, float radius, float angle, float* scratch, ClusterList& clusters,
                   ClusterIndex& index);

}  // namespace touchline
