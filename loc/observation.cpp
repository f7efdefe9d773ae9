// SPDX-License-Identifier: Apache-2.0
#include "loc/observation.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

/// A point whose range is known to this (metres, 1 sigma of tilt) counts half; for a camera at 0.6 m that is 2.6 m
/// away. What lies farther is more often no line at all: a stripe on a board stands above the ground, and its points
/// come out far away and far apart.
constexpr float telling_sigma = 0.10F;

/// Metres across the line that one sigma of pitch and of roll make at this point: ground = -h r_xy / r_z, so a tilt
/// moves it by (h^2 + d^2) / h along the sight and by d^2 / h * (cross-axis share), bounded here by d, across it.
float tilt_across(const GroundPoint& ground, const CameraPose& camera, float dir_x, float dir_y, float tilt_sigma) {
  const float x = ground.x - camera.x;
  const float y = ground.y - camera.y;
  const float d = math::max(math::hypot(x, y), 1e-3F);
  const float along_sight = math::abs(-dir_y * x + dir_x * y) / d;  // |normal . sight|
  const float h = camera.height;
  const float radial = (h * h + d * d) / h * along_sight;
  const float tangential = d * math::sqrt(math::max(0.0F, 1.0F - along_sight * along_sight));
  return tilt_sigma * math::hypot(radial, tangential);
}

LineSample make_sample(const LinePoint& p, const CameraPose& camera, const LocalizerConfig& config) {
  LineSample s;
  s.ray = p.ray;
  s.ground = p.ground;
  const auto [sine, cosine] = math::sin_cos(p.direction);
  s.dir_x = cosine;
  s.dir_y = sine;
  s.sigma = math::hypot(p.sigma, config.line_sigma_floor);
  const float tilt = tilt_across(p.ground, camera, s.dir_x, s.dir_y, config.tilt_sigma);
  s.variance = s.sigma * s.sigma + tilt * tilt;
  const float h = camera.height;
  const float spread = config.tilt_sigma *
                       (h * h + math::square(p.ground.x - camera.x) + math::square(p.ground.y - camera.y)) /
                       (h * telling_sigma);
  s.weight = math::min(1.0F, p.length / metres_per_measurement) / (1.0F + spread * spread);
  return s;
}

/// Every n-th sample, each with the weight of those it stands for.
void thin_out(Observation& out) {
  const std::size_t step = (out.lines.size() + max_filter_samples - 1) / max_filter_samples;
  out.line_weight = 0.0F;
  for (std::size_t i = 0; i < out.lines.size(); i += step) {
    LineSample s = out.lines[i];
    for (std::size_t k = i + 1; k < i + step && k < out.lines.size(); ++k) s.weight += out.lines[k].weight;
    out.line_weight += s.weight;
    out.filter_lines.push_back(s);
  }
}

}  // namespace

void make_observation(const VisionResult& vision, const LocalizerConfig& config, Observation& out) {
  out.lines.clear();
  out.filter_lines.clear();
  out.line_weight = 0.0F;
  out.camera = vision.projection.pose();
  out.features = vision.features;
  if (vision.features == nullptr || config.landmarks == Landmarks::goalposts || config.model == LocModel::paper) return;
  for (const LinePoint& p : vision.features->line_points) out.lines.push_back(make_sample(p, out.camera, config));
  thin_out(out);
}

}  // namespace touchline
