// SPDX-License-Identifier: Apache-2.0
#include "loc/observation.h"

#include "loc/localizer_config.h"
#include "platform/core/elementary.h"

namespace touchline {
namespace {

/// A point whose range is known to this (metres, 1 sigma of tilt) counts half; for a camera at 0.6 m that is 2.6 m
/// away. What lies farther is more often no line at all: a stripe on a board stands above the ground, and its points
/// come out far away and far apart.
constexpr float telling_sigma = 0.10F;

/// Square metres across the line that one sigma of pitch and of roll make at a point of squared range `d2` (at least
/// 1e-6 m^2): ground = -h r_xy / r_z, so a tilt moves it by (h^2 + d^2) / h along the sight and by d^2 / h *
/// (cross-axis share), bounded here by d, across it. `off2`: square of the line's normal times the point.
float tilt_variance(float d2, float off2, float height, float tilt_sigma) {
  const float radial = (height * height + d2) / height;
  const float tangential = math::max(0.0F, d2 - off2);  // squared, and so is the share below
  return tilt_sigma * tilt_sigma * (radial * radial * (off2 / d2) + tangential);
}

LineSample make_sample(const LinePoint& p, const CameraPose& camera, const LocalizerConfig& config) {
  LineSample s;
  s.ground = p.ground;
  s.dir_x = p.dir_x;
  s.dir_y = p.dir_y;
  s.own_variance = math::square(p.sigma) + math::square(config.line_sigma_floor);
  const float x = p.ground.x - camera.x;
  const float y = p.ground.y - camera.y;
  const float d2 = math::max(x * x + y * y, 1e-6F);
  const float off2 = math::square(s.dir_x * y - s.dir_y * x);
  const float h = camera.height;
  s.variance = s.own_variance + tilt_variance(d2, off2, h, config.tilt_sigma);
  const float spread = config.tilt_sigma * (h * h + x * x + y * y) / (h * telling_sigma);
  s.weight = math::min(1.0F, p.length / metres_per_measurement) / (1.0F + spread * spread);
  return s;
}

/// Every n-th sample, each with the weight of those it stands for.
void thin_out(Observation& out) {
  const std::size_t step = (out.lines.size() + max_filter_samples - 1) / max_filter_samples;
  const LineSampleView all = out.lines.view();
  out.line_weight = 0.0F;
  for (std::size_t i = 0; i < out.lines.size(); i += step) {
    LineSample s = out.lines[i];
    for (std::size_t k = i + 1; k < i + step && k < out.lines.size(); ++k) s.weight += all.weight[k];
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
