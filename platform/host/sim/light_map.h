// SPDX-License-Identifier: Apache-2.0
// How much of the direct light reaches each place of the ground: hard shadows of the sun, or the soft dark under a body
// below lamps. What stands still is computed once; what moves is stamped for each frame and taken off again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "platform/host/sim/room.h"
#include "platform/host/sim/solids.h"

namespace touchline::sim {

class LightMap {
 public:
  /// Covers the ground within half_length x half_width. `to_sun` points toward the sun; of length 0: lamps overhead.
  void build(float half_length, float half_width, const Vec3& to_sun, const Room& room, std::span<const Solid> still);
  /// Replaces the shadows of what moves.
  void set_moving(std::span<const Solid> moving);
  /// 0: shadow, 1: full light; bilinear.
  [[nodiscard]] float at(float x, float y) const;

 private:
  struct Box {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  };
  [[nodiscard]] bool shadow_box(const Solid& solid, Box& box) const;
  void stamp(const Solid& solid, std::vector<std::uint8_t>& level, Box& box) const;
  [[nodiscard]] std::uint8_t open_light(int x, int y, const Room& room) const;
  [[nodiscard]] Vec3 cell_centre(int x, int y) const;

  static constexpr float cell = 0.025F;
  int width_ = 0, height_ = 0;
  float left_ = 0.0F, bottom_ = 0.0F;
  Vec3 to_sun_;
  bool sun_ = false;
  std::vector<std::uint8_t> still_;
  std::vector<std::uint8_t> level_;
  std::vector<Box> stamped_;
};

}  // namespace touchline::sim
