// SPDX-License-Identifier: Apache-2.0
#include "loc/clusters.h"

#include <doctest/doctest.h>

#include <array>
#include <memory>

#include "platform/core/rng.h"

using namespace touchline;

namespace {
void scatter(ParticleView p, int from, int to, const Pose2& about, float spread, float log_weight, Rng& rng) {
  for (int i = from; i < to; ++i) {
    p.set_pose(i, {about.x + spread * rng.gaussian(), about.y + spread * rng.gaussian(),
                   wrap_angle(about.theta + spread * rng.gaussian())});
    p.log_weight[i] = log_weight;
  }
}
}  // namespace

TEST_CASE("two modes are two clusters, and the heavier is first though it has fewer particles") {
  const auto storage = std::make_unique<ParticleStorage<100>>();
  const ParticleView p = storage->view(100);
  Rng rng(1);
  scatter(p, 0, 70, {-2.0F, 1.0F, 0.0F}, 0.03F, -3.0F, rng);
  scatter(p, 70, 100, {2.0F, -1.0F, math::pi}, 0.03F, 0.0F, rng);  // at pi, where angles wrap
  ClusterList clusters;
  ClusterIndex index;
  std::array<float, max_particles> scratch;
  find_clusters(p, 0.3F, radians(15.0F), scratch.data(), clusters, index);
  REQUIRE(clusters.size() == 2);
  CHECK(clusters[0].count == 30);
  CHECK(clusters[0].mean.x == doctest::Approx(2.0).epsilon(0.02));
  CHECK(math::abs(angle_difference(clusters[0].mean.theta, math::pi)) < 0.03F);
  CHECK(clusters[0].covariance.xx == doctest::Approx(0.0009).epsilon(0.6));
  CHECK(clusters[0].mass > 0.8F);
  CHECK(clusters[0].mass + clusters[1].mass == doctest::Approx(1.0));
  CHECK(index[99] == 0);
  CHECK(index[0] == 1);
}

TEST_CASE("the same place with another heading is another cluster") {
  const auto storage = std::make_unique<ParticleStorage<40>>();
  const ParticleView p = storage->view(40);
  Rng rng(2);
  scatter(p, 0, 20, {0.0F, 0.0F, 0.0F}, 0.02F, 0.0F, rng);
  scatter(p, 20, 40, {0.0F, 0.0F, math::pi}, 0.02F, 0.0F, rng);
  ClusterList clusters;
  ClusterIndex index;
  std::array<float, max_particles> scratch;
  find_clusters(p, 0.3F, radians(15.0F), scratch.data(), clusters, index);
  CHECK(clusters.size() == 2);
}

TEST_CASE("a uniform cloud fills the list and leaves the rest out") {
  const auto storage = std::make_unique<ParticleStorage<200>>();
  const ParticleView p = storage->view(200);
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    p.set_pose(i, {rng.uniform(-7.0F, 7.0F), rng.uniform(-4.0F, 4.0F), rng.uniform(-3.0F, 3.0F)});
    p.log_weight[i] = 0.0F;
  }
  ClusterList clusters;
  ClusterIndex index;
  std::array<float, max_particles> scratch;
  find_clusters(p, 0.3F, radians(15.0F), scratch.data(), clusters, index);
  CHECK(clusters.full());
  for (std::size_t i = 1; i < clusters.size(); ++i) CHECK(clusters[i].mass <= clusters[i - 1].mass);
}
