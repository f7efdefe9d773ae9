// SPDX-License-Identifier: Apache-2.0
// The ground as the camera sees it: carpet with grain and seams, painted lines, the floor around. A pixel's share of a
// line is computed analytically from its footprint on the ground, so that far lines thinner than a pixel keep their
// brightness.
#pragma once

#include <cstdint>
#include <vector>

#include "loc/field.h"
#include "platform/host/sim/noise_tile.h"
#include "platform/host/sim/vec.h"

namespace touchline::sim {

struct GroundOptions {
  Rgb carpet;
  Rgb paint;
  Rgb floor;
  bool wood = false;              // else plain concrete
  bool cross_marks = false;       // penalty mark as a cross, else a disc
  float wear = 0.0F;              // 0..1: share of the paint that is gone
  int debris = 8;                 // bright specks of a few millimetres on the carpet
  float ragged = 0.0018F;         // metres, 1 sigma, by which the paint's edge wanders
  float grain = 0.10F;            // relative strength of the carpet's texture
  float floor_line_inset = 0.5F;  // metres between the carpet and a line on the floor; 0: no such lines
};

/// Half the extent of a pixel on the ground: its two sides as vectors, metres.
struct Footprint {
  float ux = 0.0F, uy = 0.0F;
  float vx = 0.0F, vy = 0.0F;
};

class Ground {
 public:
  void build(const FieldDimensions& field, const GroundOptions& options, std::uint64_t seed);
  /// Colour before light at a point of the field frame.
  [[nodiscard]] Rgb color(float x, float y, const Footprint& pixel) const;
  [[nodiscard]] float half_length() const { return half_length_; }
  [[nodiscard]] float half_width() const { return half_width_; }

 private:
  enum class Kind : std::uint8_t { segment, ring, disc };
  struct Mark {  // centre, unit direction, half length (segment); radius (ring, disc); half the line's width
    Kind kind = Kind::segment;
    bool on_floor = false;
    float x = 0.0F, y = 0.0F;
    float dx = 1.0F, dy = 0.0F;
    float half_length = 0.0F;
    float radius = 0.0F;
    float half_width = 0.0F;
  };
  static constexpr float cell_size = 0.25F;
  static constexpr float near_footprint = 0.2F;  // beyond, the cells' lists do not suffice and all marks are tried

  void add_segment(float ax, float ay, float bx, float by, float width, bool on_floor);
  void add_field_lines(const FieldDimensions& f);
  void add_floor_lines(float inset);
  void build_cells();
  [[nodiscard]] static float distance(const Mark& m, float x, float y);
  [[nodiscard]] static float coverage(const Mark& m, float x, float y, const Footprint& pixel, float edge);
  [[nodiscard]] float marks_coverage(float x, float y, const Footprint& pixel, float extent, float edge,
                                     bool on_floor) const;
  [[nodiscard]] Rgb carpet(float x, float y, const Footprint& pixel, float extent) const;
  [[nodiscard]] Rgb floor(float x, float y, const Footprint& pixel, float extent) const;

  GroundOptions options_;
  float half_length_ = 0.0F, half_width_ = 0.0F;
  float seam_ = 2.0F;
  std::vector<Mark> marks_;
  int cells_x_ = 0, cells_y_ = 0;
  float cells_left_ = 0.0F, cells_bottom_ = 0.0F;
  std::vector<std::uint32_t> cell_start_;
  std::vector<std::uint16_t> cell_marks_;
  NoiseTile fine_, middle_, coarse_;
};

}  // namespace touchline::sim
