// SPDX-License-Identifier: Apache-2.0
// Coverage is exact for a straight edge under a box-shaped pixel whose sides project onto the edge's normal.
#include "platform/host/sim/ground.h"

namespace touchline::sim {
namespace {

constexpr float fine_texel = 0.006F;
constexpr float middle_texel = 0.03F;
constexpr float coarse_texel = 0.12F;
constexpr float far_margin = 4.0F;  // floor beyond the carpet that the cells cover

float extent_along(const Footprint& p, float nx, float ny) {
  return math::abs(p.ux * nx + p.uy * ny) + math::abs(p.vx * nx + p.vy * ny) + 1e-5F;
}

}  // namespace

void Ground::build(const FieldDimensions& field, const GroundOptions& options, std::uint64_t seed) {
  options_ = options;
  half_length_ = field.length * 0.5F + field.border;
  half_width_ = field.width * 0.5F + field.border;
  Rng rng(seed, 1);
  fine_.generate(rng, 4, 3, 0.9F);
  middle_.generate(rng, 32, 5, 0.75F);
  coarse_.generate(rng, 64, 5, 0.6F);
  seam_ = rng.uniform(1.6F, 2.4F);
  marks_.clear();
  add_field_lines(field);
  for (int i = 0; i < options.debris; ++i) {
    Mark speck;
    speck.kind = Kind::disc;
    speck.x = rng.uniform(-half_length_, half_length_);
    speck.y = rng.uniform(-half_width_, half_width_);
    speck.radius = rng.uniform(0.003F, 0.007F);
    marks_.push_back(speck);
  }
  if (options.floor_line_inset > 0.0F) add_floor_lines(options.floor_line_inset);
  build_cells();
}

void Ground::add_segment(float ax, float ay, float bx, float by, float width, bool on_floor) {
  const float extent = length(bx - ax, by - ay);
  if (extent <= 0.0F || width <= 0.0F) return;
  Mark m;
  m.on_floor = on_floor;
  m.x = (ax + bx) * 0.5F;
  m.y = (ay + by) * 0.5F;
  m.dx = (bx - ax) / extent;
  m.dy = (by - ay) / extent;
  m.half_width = width * 0.5F;
  m.half_length = extent * 0.5F + m.half_width;  // square ends: two lines that meet fill their corner
  marks_.push_back(m);
}

void Ground::add_field_lines(const FieldDimensions& f) {
  const float w = f.line_width;
  const float x = f.length * 0.5F;
  const float y = f.width * 0.5F;
  add_segment(-x, -y, x, -y, w, false);
  add_segment(-x, y, x, y, w, false);
  add_segment(0.0F, -y, 0.0F, y, w, false);
  for (int side = -1; side <= 1; side += 2) {
    const auto s = static_cast<float>(side);
    add_segment(s * x, -y, s * x, y, w, false);
    const float areas[2][2] = {{f.goal_area_depth, f.goal_area_width * 0.5F},
                               {f.penalty_area_depth, f.penalty_area_width * 0.5F}};
    for (const auto& area : areas) {
      if (area[0] <= 0.0F || area[1] <= 0.0F) continue;
      const float front = s * (x - area[0]);
      add_segment(front, -area[1], front, area[1], w, false);
      add_segment(s * x, -area[1], front, -area[1], w, false);
      add_segment(s * x, area[1], front, area[1], w, false);
    }
    if (f.penalty_mark > 0.0F) {
      const float mark = s * (x - f.penalty_mark);
      if (options_.cross_marks) {
        add_segment(mark - 0.05F + w * 0.5F, 0.0F, mark + 0.05F - w * 0.5F, 0.0F, w * 0.7F, false);
        add_segment(mark, -0.05F + w * 0.5F, mark, 0.05F - w * 0.5F, w * 0.7F, false);
      } else {
        Mark disc;
        disc.kind = Kind::disc;
        disc.x = mark;
        disc.radius = 0.05F;
        marks_.push_back(disc);
      }
    }
  }
  Mark ring;
  ring.kind = Kind::ring;
  ring.radius = f.circle_radius;
  ring.half_width = w * 0.5F;
  if (ring.radius > 0.0F) marks_.push_back(ring);
}

void Ground::add_floor_lines(float inset) {
  const float x = half_length_ + inset;
  const float y = half_width_ + inset * 0.7F;
  add_segment(-x * 0.35F, -y, x * 0.6F, -y, 0.05F, true);
  add_segment(-x * 0.7F, y, -x * 0.1F, y, 0.08F, true);
  add_segment(x, -y * 0.5F, x, y * 0.9F, 0.05F, true);
  add_segment(-x - 0.2F, -y * 0.2F, -x, y * 0.8F, 0.06F, true);
}

float Ground::distance(const Mark& m, float x, float y) {
  const float rx = x - m.x;
  const float ry = y - m.y;
  if (m.kind == Kind::segment) {
    const float along = math::max(math::abs(rx * m.dx + ry * m.dy) - m.half_length, 0.0F);
    const float across = math::max(math::abs(-rx * m.dy + ry * m.dx) - m.half_width, 0.0F);
    return length(along, across);
  }
  const float r = length(rx, ry);
  if (m.kind == Kind::disc) return math::max(r - m.radius, 0.0F);
  return math::max(math::abs(r - m.radius) - m.half_width, 0.0F);
}

void Ground::build_cells() {
  cells_left_ = -half_length_ - far_margin;
  cells_bottom_ = -half_width_ - far_margin;
  cells_x_ = static_cast<int>(-2.0F * cells_left_ / cell_size) + 1;
  cells_y_ = static_cast<int>(-2.0F * cells_bottom_ / cell_size) + 1;
  cell_start_.clear();
  cell_marks_.clear();
  const float reach = cell_size * 0.7072F + near_footprint;
  for (int j = 0; j < cells_y_; ++j) {
    for (int i = 0; i < cells_x_; ++i) {
      cell_start_.push_back(static_cast<std::uint32_t>(cell_marks_.size()));
      const float x = cells_left_ + (static_cast<float>(i) + 0.5F) * cell_size;
      const float y = cells_bottom_ + (static_cast<float>(j) + 0.5F) * cell_size;
      for (std::size_t m = 0; m < marks_.size(); ++m) {
        if (distance(marks_[m], x, y) < reach) cell_marks_.push_back(static_cast<std::uint16_t>(m));
      }
    }
  }
  cell_start_.push_back(static_cast<std::uint32_t>(cell_marks_.size()));
}

float Ground::coverage(const Mark& m, float x, float y, const Footprint& pixel, float edge) {
  const float rx = x - m.x;
  const float ry = y - m.y;
  if (m.kind == Kind::segment) {
    const float half = extent_along(pixel, -m.dy, m.dx);
    const float across = covered(-rx * m.dy + ry * m.dx + edge, half, -m.half_width, m.half_width);
    if (across <= 0.0F) return 0.0F;
    return across * covered(rx * m.dx + ry * m.dy, extent_along(pixel, m.dx, m.dy), -m.half_length, m.half_length);
  }
  const float r = length(rx, ry);
  const float nx = r > 1e-6F ? rx / r : 1.0F;
  const float ny = r > 1e-6F ? ry / r : 0.0F;
  const float half = extent_along(pixel, nx, ny);
  if (m.kind == Kind::ring) return covered(r - m.radius + edge, half, -m.half_width, m.half_width);
  // A disc: its chord across the pixel, in both directions.
  const float tangent = extent_along(pixel, -ny, nx);
  const float side = math::min(1.0F, m.radius * 0.886F / tangent);
  return covered(r + edge, half, -m.radius, m.radius) * side;
}

float Ground::marks_coverage(float x, float y, const Footprint& pixel, float extent, float edge, bool on_floor) const {
  float free = 1.0F;
  if (extent >= near_footprint) {
    for (const Mark& m : marks_) {
      if (m.on_floor == on_floor) free *= 1.0F - coverage(m, x, y, pixel, edge);
    }
    return 1.0F - free;
  }
  const int i = floor_int((x - cells_left_) * (1.0F / cell_size));
  const int j = floor_int((y - cells_bottom_) * (1.0F / cell_size));
  if (i < 0 || j < 0 || i >= cells_x_ || j >= cells_y_) return 0.0F;
  const auto cell = static_cast<std::size_t>(j * cells_x_ + i);
  for (std::uint32_t k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
    const Mark& m = marks_[cell_marks_[k]];
    if (m.on_floor == on_floor) free *= 1.0F - coverage(m, x, y, pixel, edge);
  }
  return 1.0F - free;
}

Rgb Ground::carpet(float x, float y, const Footprint& pixel, float extent) const {
  // The grain fades where a pixel spans several texels: the sum of many is their mean.
  const float fine_strength = fine_texel / (fine_texel + extent);
  const float middle_strength = middle_texel / (middle_texel + extent);
  const float fine =
      extent < 0.03F ? fine_.sample(x * (1.0F / fine_texel), y * (1.0F / fine_texel)) * fine_strength : 0.0F;
  const float middle =
      (extent < 0.5F * middle_texel ? middle_.sample(x * (1.0F / middle_texel), y * (1.0F / middle_texel))
                                    : middle_.nearest(x * (1.0F / middle_texel), y * (1.0F / middle_texel))) *
      middle_strength;
  const float coarse = coarse_.nearest(x * (2.0F / coarse_texel), y * (2.0F / coarse_texel));
  float shade = 1.0F + options_.grain * (1.6F * fine + 0.7F * middle + 0.35F * coarse);
  const float strip = y / seam_;
  const float seam = (strip - static_cast<float>(floor_int(strip)) - 0.37F) * seam_;
  shade *= 1.0F - 0.18F * covered(seam, extent_along(pixel, 0.0F, 1.0F), -0.006F, 0.006F);
  const Rgb green = options_.carpet * math::max(shade, 0.25F);

  // Paint follows the pile: its edge is ragged by a few millimetres, and worn where feet have been.
  const float edge = extent < 0.02F ? options_.ragged * (fine + 0.8F * middle) : 0.0F;
  const float paint = marks_coverage(x, y, pixel, extent, edge, false);
  if (paint <= 0.0F) return green;
  const float worn = math::clamp(options_.wear * (1.0F + 0.6F * middle + 0.5F * fine), 0.0F, 0.95F);
  const Rgb white = options_.paint * (1.0F + 0.5F * options_.grain * fine);
  return mix(green, white, paint * (1.0F - worn));
}

Rgb Ground::floor(float x, float y, const Footprint& pixel, float extent) const {
  const float grain = middle_.nearest(x * 25.0F, y * 25.0F) * 0.04F;
  float shade = 1.0F + grain + 0.06F * coarse_.nearest(x * 4.0F, y * 4.0F);
  if (options_.wood) {
    const int plank = floor_int(y / 0.11F);
    const int piece = floor_int(x / 0.9F + cell_random(plank, 0, 11U));
    shade += 0.35F * (cell_random(plank, piece, 23U) - 0.5F);
  }
  const Rgb base = options_.floor * shade;
  const float paint = marks_coverage(x, y, pixel, extent, 0.0F, true);
  return paint > 0.0F ? mix(base, options_.paint * 0.9F, paint) : base;
}

Rgb Ground::color(float x, float y, const Footprint& pixel) const {
  const float half_x = math::abs(pixel.ux) + math::abs(pixel.vx) + 1e-5F;
  const float half_y = math::abs(pixel.uy) + math::abs(pixel.vy) + 1e-5F;
  const float extent = math::max(half_x, half_y);
  const float past = math::max(math::abs(x) - half_length_, math::abs(y) - half_width_);
  if (past < -extent) return carpet(x, y, pixel, extent);
  if (past > extent) return floor(x, y, pixel, extent);
  const float on_carpet =
      covered(x, half_x, -half_length_, half_length_) * covered(y, half_y, -half_width_, half_width_);
  return mix(floor(x, y, pixel, extent), carpet(x, y, pixel, extent), on_carpet);
}

}  // namespace touchline::sim
