// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/lens_map.h"

#include <algorithm>

#include "platform/host/sim/vec.h"

namespace touchline::sim {

void LensMap::build(const Lens& lens, int width, int height) {
  lens_ = lens;
  width_ = width;
  height_ = height;
  min_cosine_ = math::cos(lens.parameters().max_theta);
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  x_.assign(pixels, 0.0F);
  y_.assign(pixels, 0.0F);
  z_.assign(pixels, -1.0F);
  first_.assign(static_cast<std::size_t>(height), width);
  last_.assign(static_cast<std::size_t>(height), 0);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      Vec3 ray;
      const PixelPoint p{static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F};
      if (!lens.ray(p, ray)) continue;
      const std::size_t i = offset(row) + static_cast<std::size_t>(column);
      x_[i] = ray.x;
      y_[i] = ray.y;
      z_[i] = ray.z;
      const auto r = static_cast<std::size_t>(row);
      first_[r] = std::min(first_[r], column);
      last_[r] = column + 1;
    }
    if (last_[static_cast<std::size_t>(row)] == 0) first_[static_cast<std::size_t>(row)] = 0;
  }
  build_tiles();
}

TileCone LensMap::cone(int tile_x, int tile_y) const {
  TileCone c;
  const int y1 = std::min((tile_y + 1) * tile, height_);
  Vec3 sum;
  int seen = 0;
  for (int y = tile_y * tile; y < y1; ++y) {
    for (int i = std::max(tile_x * tile, first(y)); i < std::min((tile_x + 1) * tile, last(y)); ++i) {
      sum = sum + Vec3{x(y)[i], y_[offset(y) + static_cast<std::size_t>(i)], z(y)[i]};
      seen += 1;
    }
  }
  if (seen == 0) return c;
  c.axis = normalized(sum);
  c.cosine = 1.0F;
  for (int y = tile_y * tile; y < y1; ++y) {
    for (int i = std::max(tile_x * tile, first(y)); i < std::min((tile_x + 1) * tile, last(y)); ++i) {
      c.cosine = math::min(c.cosine, dot(c.axis, {x(y)[i], y_[offset(y) + static_cast<std::size_t>(i)], z(y)[i]}));
    }
  }
  c.sine = square_root(math::max(1.0F - c.cosine * c.cosine, 0.0F)) + 0.004F;  // half a pixel of slack
  c.cosine = square_root(1.0F - math::min(c.sine * c.sine, 1.0F));
  return c;
}

void LensMap::build_tiles() {
  tiles_.clear();
  for (int ty = 0; ty < (height_ + tile - 1) / tile; ++ty) {
    for (int tx = 0; tx < tiles_x(); ++tx) tiles_.push_back(cone(tx, ty));
  }
}

}  // namespace touchline::sim
