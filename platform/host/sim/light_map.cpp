// SPDX-License-Identifier: Apache-2.0
// Shadows by asking each cell near a solid's shadow whether the way to the light is free.
#include "platform/host/sim/light_map.h"

#include <algorithm>

namespace touchline::sim {

Vec3 LightMap::cell_centre(int x, int y) const {
  return {left_ + (static_cast<float>(x) + 0.5F) * cell, bottom_ + (static_cast<float>(y) + 0.5F) * cell, 0.0F};
}

std::uint8_t LightMap::open_light(int x, int y, const Room& room) const {
  const Vec3 p = cell_centre(x, y);
  if (sun_) {
    int open = 0;
    for (int k = 0; k < 4; ++k) {
      const Vec3 sub{p.x + ((k & 1) != 0 ? 0.25F : -0.25F) * cell, p.y + ((k & 2) != 0 ? 0.25F : -0.25F) * cell, 0.0F};
      if (room.through_window(sub, to_sun_)) open += 1;
    }
    return static_cast<std::uint8_t>(open * 255 / 4);
  }
  // Rows of lamps: brighter below them, by a gentle wave.
  const float wave = math::cos(p.x * 2.8F) * math::cos(p.y * 2.5F);
  return static_cast<std::uint8_t>(225.0F + 25.0F * wave);
}

void LightMap::build(float half_length, float half_width, const Vec3& to_sun, const Room& room,
                     std::span<const Solid> still) {
  left_ = -half_length;
  bottom_ = -half_width;
  width_ = static_cast<int>(2.0F * half_length / cell) + 1;
  height_ = static_cast<int>(2.0F * half_width / cell) + 1;
  sun_ = dot(to_sun, to_sun) > 0.0F;
  to_sun_ = normalized(to_sun);
  still_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) still_[static_cast<std::size_t>(y * width_ + x)] = open_light(x, y, room);
  }
  Box box;
  for (const Solid& solid : still) stamp(solid, still_, box);
  level_ = still_;
  stamped_.clear();
}

bool LightMap::shadow_box(const Solid& solid, Box& box) const {
  const Vec3& c = solid.centre;
  float x0 = c.x - solid.bound;
  float x1 = c.x + solid.bound;
  float y0 = c.y - solid.bound;
  float y1 = c.y + solid.bound;
  if (sun_) {
    // The bounding sphere slides along the sun's rays from its highest to the ground.
    const float far = (c.z + solid.bound) / to_sun_.z;
    const float near = math::max(c.z - solid.bound, 0.0F) / to_sun_.z;
    x0 = math::min(c.x - to_sun_.x * near, c.x - to_sun_.x * far) - solid.bound;
    x1 = math::max(c.x - to_sun_.x * near, c.x - to_sun_.x * far) + solid.bound;
    y0 = math::min(c.y - to_sun_.y * near, c.y - to_sun_.y * far) - solid.bound;
    y1 = math::max(c.y - to_sun_.y * near, c.y - to_sun_.y * far) + solid.bound;
  } else {
    const float soft = 0.10F + 0.5F * c.z;
    x0 -= soft;
    x1 += soft;
    y0 -= soft;
    y1 += soft;
  }
  const auto column = [&](float x) { return std::clamp(floor_int((x - left_) / cell), 0, width_); };
  const auto row = [&](float y) { return std::clamp(floor_int((y - bottom_) / cell), 0, height_); };
  box = {column(x0), row(y0), column(x1) + 1, row(y1) + 1};
  box.x1 = std::min(box.x1, width_);
  box.y1 = std::min(box.y1, height_);
  return box.x0 < box.x1 && box.y0 < box.y1;
}

void LightMap::stamp(const Solid& solid, std::vector<std::uint8_t>& level, Box& box) const {
  if (!shadow_box(solid, box)) return;
  const float soft = 0.10F + 0.5F * solid.centre.z + 0.6F * solid.bound;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      std::uint8_t& value = level[static_cast<std::size_t>(y * width_ + x)];
      if (value == 0) continue;
      const Vec3 p = cell_centre(x, y);
      if (sun_) {
        SolidHit hit;
        if (intersect(solid, p, to_sun_, 1e6F, hit)) value = 0;
      } else {
        const float away = length(p.x - solid.centre.x, p.y - solid.centre.y) / soft;
        const float dark = away < 1.0F ? 0.22F * (1.0F - away) / (1.0F + 2.0F * solid.centre.z) : 0.0F;
        value = static_cast<std::uint8_t>(static_cast<float>(value) * (1.0F - dark));
      }
    }
  }
}

void LightMap::set_moving(std::span<const Solid> moving) {
  for (const Box& box : stamped_) {
    for (int y = box.y0; y < box.y1; ++y) {
      const auto row = static_cast<std::ptrdiff_t>(y) * width_;
      std::copy(still_.begin() + row + box.x0, still_.begin() + row + box.x1, level_.begin() + row + box.x0);
    }
  }
  stamped_.clear();
  for (const Solid& solid : moving) {
    Box box;
    stamp(solid, level_, box);
    if (box.x1 > box.x0) stamped_.push_back(box);
  }
}

float LightMap::at(float x, float y) const {
  const float px = (x - left_) * (1.0F / cell) - 0.5F;
  const float py = (y - bottom_) * (1.0F / cell) - 0.5F;
  if (px < 0.0F || py < 0.0F) return 0.85F;
  const int ix = static_cast<int>(px);
  const int iy = static_cast<int>(py);
  if (ix + 1 >= width_ || iy + 1 >= height_) return 0.85F;
  const std::uint8_t* row = &level_[static_cast<std::size_t>(iy * width_ + ix)];
  const float fx = px - static_cast<float>(ix);
  const float fy = py - static_cast<float>(iy);
  const float top = static_cast<float>(row[0]) * (1.0F - fx) + static_cast<float>(row[1]) * fx;
  const float bottom = static_cast<float>(row[width_]) * (1.0F - fx) + static_cast<float>(row[width_ + 1]) * fx;
  return (top * (1.0F - fy) + bottom * fy) * (1.0F / 255.0F);
}

}  // namespace touchline::sim
