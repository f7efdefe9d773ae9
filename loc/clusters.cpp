// SPDX-License-Identifier: Apache-2.0
#include "loc/clusters.h"

#include "loc/resampling.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

struct Gather {
  ParticleView particles;
  const float* weights;  // not logarithms
  ClusterIndex& index;
  float radius, angle;
  std::array<std::uint16_t, max_particles> free{};  // those that no cluster has taken yet, in their order
  int free_count = 0;

  /// Calls `take(i, dx, dy, dt)` for each free particle near `about`, with its difference to it: pi is no edge.
  template <typename Take>
  void for_each_near(const Pose2& about, Take take) const {
    const float radius2 = radius * radius;
    for (int k = 0; k < free_count; ++k) {
      const int i = free[static_cast<std::size_t>(k)];
      const float dx = particles.x[i] - about.x;
      const float dy = particles.y[i] - about.y;
      if (!(dx * dx + dy * dy < radius2)) continue;
      const float dt = angle_difference(particles.theta[i], about.theta);
      if (math::abs(dt) < angle) take(i, dx, dy, dt);
    }
  }

  /// Weighted mean of the free particles near `about`.
  Cluster mean_near(const Pose2& about) const {
    Cluster c;
    float sx = 0.0F;
    float sy = 0.0F;
    float st = 0.0F;
    for_each_near(about, [&](int i, float dx, float dy, float dt) {
      const float w = weights[i];
      c.mass += w;
      sx += w * dx;
      sy += w * dy;
      st += w * dt;
      ++c.count;
    });
    c.mean = about;
    if (c.mass > 0.0F) {
      c.mean = {about.x + sx / c.mass, about.y + sy / c.mass, wrap_angle(about.theta + st / c.mass)};
    }
    return c;
  }

  void take(Cluster& c, std::uint8_t id) {
    PoseCovariance s;
    for_each_near(c.mean, [&](int i, float dx, float dy, float dt) {
      index[static_cast<std::size_t>(i)] = id;
      const float w = weights[i] / c.mass;
      s.xx += w * dx * dx;
      s.xy += w * dx * dy;
      s.yy += w * dy * dy;
      s.xt += w * dx * dt;
      s.yt += w * dy * dt;
      s.tt += w * dt * dt;
    });
    c.covariance = s;
  }

  [[nodiscard]] int heaviest_free() const {
    int best = -1;
    for (int k = 0; k < free_count; ++k) {
      const int i = free[static_cast<std::size_t>(k)];
      if (best < 0 || particles.log_weight[i] > particles.log_weight[best]) best = i;
    }
    return best;
  }

  /// The first cluster takes most, and the others need not ask for them again.
  void forget_taken() {
    int left = 0;
    for (int k = 0; k < free_count; ++k) {
      const std::uint16_t i = free[static_cast<std::size_t>(k)];
      free[static_cast<std::size_t>(left)] = i;
      left += index[i] == no_cluster ? 1 : 0;
    }
    free_count = left;
  }
};

void sort_heaviest_first(ClusterList& clusters, ClusterIndex& index, int count) {
  std::array<std::uint8_t, max_clusters> order{};
  for (std::size_t i = 0; i < clusters.size(); ++i) order[i] = static_cast<std::uint8_t>(i);
  for (std::size_t i = 1; i < clusters.size(); ++i) {
    for (std::size_t k = i; k > 0 && clusters[k - 1].mass < clusters[k].mass; --k) {
      const Cluster c = clusters[k];
      clusters[k] = clusters[k - 1];
      clusters[k - 1] = c;
      const std::uint8_t o = order[k];
      order[k] = order[k - 1];
      order[k - 1] = o;
    }
  }
  std::array<std::uint8_t, max_clusters> rank{};
  for (std::size_t i = 0; i < clusters.size(); ++i) rank[order[i]] = static_cast<std::uint8_t>(i);
  for (int i = 0; i < count; ++i) {
    std::uint8_t& id = index[static_cast<std::size_t>(i)];
    if (id != no_cluster) id = rank[id];
  }
}

}  // namespace

void find_clusters(ParticleView particles, float radius, float angle, float* scratch, ClusterList& clusters,
                   ClusterIndex& index) {
  clusters.clear();
  index.fill(no_cluster);
  normalize_log_weights(particles);
  float total = 0.0F;
  for (int i = 0; i < particles.count; ++i) {
    scratch[i] = math::exp(particles.log_weight[i]);
    total += scratch[i];
  }
  Gather gather{particles, scratch, index, radius, angle};
  for (; gather.free_count < particles.count; ++gather.free_count) {
    gather.free[static_cast<std::size_t>(gather.free_count)] = static_cast<std::uint16_t>(gather.free_count);
  }
  while (!clusters.full()) {
    const int seed = gather.heaviest_free();
    if (seed < 0) break;
    Cluster c = gather.mean_near(particles.pose(seed));
    c = gather.mean_near(c.mean);
    if (c.mass <= 0.0F) {  // the mean has left all particles behind: take the seed alone
      c.mean = particles.pose(seed);
      c = gather.mean_near(c.mean);
      c.mean = particles.pose(seed);
    }
    const auto id = static_cast<std::uint8_t>(clusters.size());
    if (c.mass > 0.0F) gather.take(c, id);
    index[static_cast<std::size_t>(seed)] = id;  // also when the mean has moved away: every turn takes one at least
    gather.forget_taken();
    c.mass = total > 0.0F ? c.mass / total : 0.0F;
    clusters.push_back(c);
  }
  sort_heaviest_first(clusters, index, particles.count);
}

}  // namespace touchline
