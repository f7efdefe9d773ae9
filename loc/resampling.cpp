// SPDX-License-Identifier: Apache-2.0
#include "loc/resampling.h"

#include <cassert>

#include "platform/core/elementary.h"

namespace touchline {

namespace {
constexpr float hopeless_log_weight = -1.0e6F;
}  // namespace

float normalize_log_weights(ParticleView particles) {
  if (particles.count == 0) return 0.0F;
  for (int i = 0; i < particles.count; ++i) {  // one weight that is no number must not make all of them such
    if (!math::is_finite(particles.log_weight[i])) particles.log_weight[i] = hopeless_log_weight;
  }
  float best = particles.log_weight[0];
  for (int i = 1; i < particles.count; ++i) best = math::max(best, particles.log_weight[i]);
  for (int i = 0; i < particles.count; ++i) particles.log_weight[i] -= best;
  return best;
}

float effective_count(ParticleView particles) {
  normalize_log_weights(particles);
  float sum = 0.0F;
  float squares = 0.0F;
  for (int i = 0; i < particles.count; ++i) {
    const float w = math::exp(particles.log_weight[i]);
    sum += w;
    squares += w * w;
  }
  return squares > 0.0F ? sum * sum / squares : 0.0F;
}

namespace {

/// Each of the first places gets the particle drawn for it. The numbers drawn never fall, so a place that takes one
/// from below is wanted by none before it, nor one that takes from above by any behind it: no copy is needed.
void take_drawn(ParticleView particles, std::span<const std::uint16_t> drawn) {
  const int places = static_cast<int>(drawn.size());
  const auto source = [&](int i) { return int{drawn[static_cast<std::size_t>(i)]}; };
  for (int i = places - 1; i >= 0; --i) {
    if (source(i) < i) particles.set_pose(i, particles.pose(source(i)));
  }
  for (int i = 0; i < places; ++i) {
    if (source(i) > i) particles.set_pose(i, particles.pose(source(i)));
  }
}

}  // namespace

void resample_low_variance(ParticleView particles, int keep, const ResamplingMemory& memory, Rng& rng) {
  const auto count = static_cast<std::size_t>(particles.count);
  assert(keep >= 0 && keep <= particles.count && memory.weights.size() >= count && memory.drawn.size() >= count);
  if (keep == 0) return;
  normalize_log_weights(particles);
  float total = 0.0F;
  float last = 0.0F;  // normalised, the best weight: neighbours are often equal
  float weight = 1.0F;
  for (std::size_t i = 0; i < count; ++i) {
    if (particles.log_weight[i] != last) {
      last = particles.log_weight[i];
      weight = math::exp(last);
    }
    memory.weights[i] = weight;
    total += weight;
  }
  const float step = total / static_cast<float>(keep);
  const float offset = step * rng.uniform();
  float sum = memory.weights[0];
  std::size_t from = 0;
  for (int i = 0; i < keep; ++i) {
    const float target = offset + step * static_cast<float>(i);
    while (sum < target && from + 1 < count) sum += memory.weights[++from];
    memory.drawn[static_cast<std::size_t>(i)] = static_cast<std::uint16_t>(from);
    particles.log_weight[i] = 0.0F;
  }
  take_drawn(particles, memory.drawn.first(static_cast<std::size_t>(keep)));
}

int part_of(int count, float share) {
  return share > 0.0F ? static_cast<int>(math::min(share, 1.0F) * static_cast<float>(count)) : 0;
}

namespace {

float extent(const float* values, int count) {
  float low = values[0];
  float high = values[0];
  for (int i = 1; i < count; ++i) {
    low = math::min(low, values[i]);
    high = math::max(high, values[i]);
  }
  return high - low;
}

}  // namespace

void roughen(ParticleView particles, float k, Rng& rng) {
  if (particles.count == 0) return;
  const float share = k * math::exp(-math::log(static_cast<float>(particles.count)) / 3.0F);
  const float sx = share * extent(particles.x, particles.count);
  const float sy = share * extent(particles.y, particles.count);
  const float st = share * math::min(extent(particles.theta, particles.count), math::pi);
  for (int i = 0; i < particles.count; ++i) {
    particles.x[i] += sx * rng.gaussian();
    particles.y[i] += sy * rng.gaussian();
    particles.theta[i] = wrap_angle(particles.theta[i] + st * rng.gaussian());
  }
}

}  // namespace touchline
