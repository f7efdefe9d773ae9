// SPDX-License-Identifier: Apache-2.0
#include "tests/support/synthetic_view.h"

#include <doctest/doctest.h>

#include "platform/core/elementary.h"

namespace touchline::test {

SyntheticView::SyntheticView(const Field& field, const Lens& lens, int frame_width, int frame_height)
    : field_(field),
      lens_(lens),
      frame_width_(frame_width),
      frame_height_(frame_height),
      memory_(std::make_unique<Memory>()) {}

bool SyntheticView::see(const GroundPoint& ground, float noise, Rng& rng, PixelPoint& pixel) const {
  if (!true_projection_.pixel(ground, pixel)) return false;
  pixel.u += noise * rng.gaussian();
  pixel.v += noise * rng.gaussian();
  return pixel.u > 1.0F && pixel.v > 1.0F && pixel.u < static_cast<float>(frame_width_) - 1.0F &&
         pixel.v < static_cast<float>(frame_height_) - 1.0F;
}

void SyntheticView::add_line_point(const GroundProjection& told, const GroundPoint& ground, float direction,
                                   float length, Rng& rng) {
  if (ground.x * ground.x + ground.y * ground.y > options_.max_range * options_.max_range) return;
  LinePoint p;
  if (!see(ground, options_.pixel_noise, rng, p.pixel)) return;
  if (!options_.lines || !told.ground(p.pixel, p.ground)) return;
  p.dir_x = math::cos(direction);
  p.dir_y = math::sin(direction);
  p.length = length;
  p.sigma = math::sqrt(told.ground_covariance(p.pixel, 2.0F, 0.0F).xx);
  memory_->features.line_points.push_back(p);
}

/// The lines' middle, without a gap in the working picture.
void SyntheticView::draw_line_mask(const Pose2& truth) {
  constexpr float spacing = 0.005F;
  const auto draw = [&](const FieldPoint& at) {
    const GroundPoint ground = to_ground(truth, at);
    PixelPoint p;
    if (ground.x * ground.x + ground.y * ground.y > options_.max_range * options_.max_range) return;
    if (!true_projection_.pixel(ground, p) || p.u < 0.0F || p.v < 0.0F) return;
    const int x = static_cast<int>(p.u * 320.0F / static_cast<float>(frame_width_));
    const int y = static_cast<int>(p.v * 240.0F / static_cast<float>(frame_height_));
    if (x < 320 && y < 240) memory_->lines.view().set(x, y, true);
  };
  for (const FieldLine& line : field_.lines()) {
    const float length = math::hypot(line.b.x - line.a.x, line.b.y - line.a.y);
    const int steps = static_cast<int>(length / spacing);
    for (int i = 0; i <= steps; ++i) {
      const float t = static_cast<float>(i) / static_cast<float>(steps);
      draw({line.a.x + (line.b.x - line.a.x) * t, line.a.y + (line.b.y - line.a.y) * t});
    }
  }
  const float r = field_.dimensions().circle_radius;
  const int steps = static_cast<int>(math::two_pi * r / spacing);
  for (int i = 0; i < steps; ++i) {
    const float a = math::two_pi * static_cast<float>(i) / static_cast<float>(steps);
    draw({r * math::cos(a), r * math::sin(a)});
  }
}

void SyntheticView::add_lines(const Pose2& truth, Rng& rng) {
  constexpr float spacing = 0.05F;
  const auto half_turn = [](float a) { return math::atan(math::tan(a)); };
  for (const FieldLine& line : field_.lines()) {
    const float length = math::hypot(line.b.x - line.a.x, line.b.y - line.a.y);
    const float direction = math::atan2(line.b.y - line.a.y, line.b.x - line.a.x) - truth.theta;
    for (float s = 0.0F; s < length; s += spacing) {
      const FieldPoint p{line.a.x + (line.b.x - line.a.x) * s / length, line.a.y + (line.b.y - line.a.y) * s / length};
      add_line_point(told_projection_, to_ground(truth, p), half_turn(direction), spacing, rng);
    }
  }
  const float r = field_.dimensions().circle_radius;
  for (float a = 0.0F; a < math::two_pi; a += spacing / r) {
    add_line_point(told_projection_, to_ground(truth, {r * math::cos(a), r * math::sin(a)}),
                   half_turn(a + math::half_pi - truth.theta), spacing, rng);
  }
}

void SyntheticView::add_junctions(const Pose2& truth, Rng& rng) {
  for (const FieldLandmark& l : field_.landmarks()) {
    const GroundPoint g = to_ground(truth, l.at);
    Junction j;
    if (math::hypot(g.x, g.y) > 2.5F || !see(g, options_.pixel_noise, rng, j.pixel)) continue;
    if (!told_projection_.ground(j.pixel, j.ground)) continue;
    j.type = l.type;
    j.branches = l.branches;
    for (int i = 0; i < l.branches; ++i) {
      j.direction[static_cast<std::size_t>(i)] = wrap_angle(l.direction[i] - truth.theta);
    }
    j.covariance = told_projection_.ground_covariance(j.pixel, 2.0F, radians(0.5F));
    j.confidence = 0.9F;
    memory_->features.junctions.push_back(j);
  }
}

const VisionResult& SyntheticView::look(const Pose2& truth, const CameraPose& camera, const SyntheticOptions& options,
                                        Rng& rng) {
  options_ = options;
  CameraPose real = camera;
  real.pitch += options.pitch_error;
  real.roll += options.roll_error;
  true_projection_ = GroundProjection(lens_, real);
  told_projection_ = GroundProjection(lens_, camera);
  *memory_ = {};
  for (auto* mask : {&memory_->roi, &memory_->green}) {
    for (int y = 0; y < 240; ++y) {
      for (int x = 0; x < 320; ++x) mask->view().set(x, y, !options.covered);
    }
  }
  if (!options.covered) {
    draw_line_mask(truth);
    add_lines(truth, rng);
  }
  if (!options.covered && options.junctions) add_junctions(truth, rng);
  result_ = {};
  result_.projection = told_projection_;
  result_.frame_width = frame_width_;
  result_.frame_height = frame_height_;
  result_.work_width = 320;
  result_.work_height = 240;
  result_.roi = memory_->roi.view();
  result_.green = memory_->green.view();
  result_.line_mask = memory_->lines.view();
  result_.features = &memory_->features;
  return result_;
}

}  // namespace touchline::test
