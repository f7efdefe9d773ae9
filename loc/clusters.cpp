// SPDX-License-Identifier: Apache-2.0
#include "loc/clusters.h"

#include "loc/resampling.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

struct Gather {
  ParticleView particles;
  ClusterIndex& index;
  float radius, angle;

  [[nodiscard]] bool near(int i, const Pose2& p) const {
    return math::square(particles.x[i] - p.x) + math::square(particles.y[i] - p.y) < radius * radius &&
           math::abs(angle_difference(particles.theta[i], p.theta)) < angle;
  }

  /// Weighted mean of the free particles near `about`; angles as differences to it, so that pi is no edge.
  Cluster mean_near(const Pose2& about) const {
    Cluster c;
    float sx = 0.0F;
    float sy = 0.0F;
    float st = 0.0F;
    for (int i = 0; i < particles.count; ++i) {
      if (index[static_cast<std::size_t>(i)] != no_cluster || !near(i, about)) continue;
      const float w = math::exp(particles.log_weight[i]);
      c.mass += w;
      sx += w * (particles.x[i] - about.x);
      sy += w * (particles.y[i] - about.y);
      st += w * angle_difference(particles.theta[i], about.theta);
      ++c.count;
    }
    c.mean = about;
    if (c.mass > 0.0F) {
      c.mean = {about.x + sx / c.mass, about.y + sy / c.mass, wrap_angle(about.theta + st / c.mass)};
    }
    return c;
  }

  void take(Cluster& c, std::uint8_t id) {
    PoseCovariance s;
    for (int i = 0; i < particles.count; ++i) {
      if (index[static_cast<std::size_t>(i)] != no_cluster || !near(i, c.mean)) continue;
      index[static_cast<std::size_t>(i)] = id;
      const float w = math::exp(particles.log_weight[i]) / c.mass;
      const float dx = particles.x[i] - c.mean.x;
      const float dy = particles.y[i] - c.mean.y;
      const float dt = angle_difference(particles.theta[i], c.mean.theta);
      s.xx += w * dx * dx;
      s.xy += w * dx * dy;
      s.yy += w * dy * dy;
      s.xt += w * dx * dt;
      s.yt += w * dy * dt;
      s.tt += w * dt * dt;
    }
    c.covariance = s;
  }

  [[nodiscard]] int heaviest_free() const {
    int best = -1;
    for (int i = 0; i < particles.count; ++i) {
      if (index[static_cast<std::size_t>(i)] != no_cluster) continue;
      if (best < 0 || particles.log_weight[i] > particles.log_weight[best]) best = i;
    }
    return best;
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

void find_clusters(ParticleView particles, float radius, float angle, ClusterList& clusters, ClusterIndex& index) {
  clusters.clear();
  index.fill(no_cluster);
  normalize_log_weights(particles);
  Gather gather{particles, index, radius, angle};
  float total = 0.0F;
  for (int i = 0; i < particles.count; ++i) total += math::exp(particles.log_weight[i]);
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
    c.mass = total > 0.0F ? c.mass / total : 0.0F;
    clusters.push_back(c);
  }
  sort_heaviest_first(clusters, index, particles.count);
}

}  // namespace touchline
