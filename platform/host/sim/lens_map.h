// SPDX-License-Identifier: Apache-2.0
// The ray of every pixel, computed once per lens and image size, and the cones of its 16 x 16 tiles.
#pragma once

#include <cstddef>
#include <vector>

#include "vision/lens/lens.h"

namespace touchline::sim {

struct TileCone {
  Vec3 axis;            // unit vector, optical frame
  float cosine = 2.0F;  // of the half angle that holds all the tile's rays; 2: the tile sees nothing
  float sine = 0.0F;
};

class LensMap {
 public:
  static constexpr int tile = 16;
  /// `lens` has been checked by Lens::create; width, height > 0.
  void build(const Lens& lens, int width, int height);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Lens& lens() const { return lens_; }
  [[nodiscard]] const float* x(int row) const { return &x_[offset(row)]; }
  [[nodiscard]] const float* y(int row) const { return &y_[offset(row)]; }
  [[nodiscard]] const float* z(int row) const { return &z_[offset(row)]; }
  /// Columns [first, last) of a row that see something; outside all is black. Image circles are convex.
  [[nodiscard]] int first(int row) const { return first_[static_cast<std::size_t>(row)]; }
  [[nodiscard]] int last(int row) const { return last_[static_cast<std::size_t>(row)]; }
  [[nodiscard]] int tiles_x() const { return (width_ + tile - 1) / tile; }
  [[nodiscard]] const std::vector<TileCone>& tiles() const { return tiles_; }
  [[nodiscard]] float min_cosine() const { return min_cosine_; }

 private:
  [[nodiscard]] std::size_t offset(int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_);
  }
  void build_tiles();
  [[nodiscard]] TileCone cone(int tile_x, int tile_y) const;

  Lens lens_;
  int width_ = 0, height_ = 0;
  float min_cosine_ = -1.0F;
  std::vector<float> x_, y_, z_;
  std::vector<int> first_, last_;
  std::vector<TileCone> tiles_;
};

}  // namespace touchline::sim
