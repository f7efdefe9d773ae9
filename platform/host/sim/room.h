// SPDX-License-Identifier: Apache-2.0
// The hall around the field: four walls, ceiling, and what hangs on them. The sun, where there is one, falls through
// the same windows that the camera sees.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "platform/host/sim/noise_tile.h"
#include "platform/host/sim/solids.h"

namespace touchline::sim {

struct WallItem {  // a rectangle on a wall: s along it, z up
  enum class Kind : std::uint8_t { window, poster, door, lamp } kind = Kind::poster;
  float s0 = 0.0F, s1 = 1.0F, z0 = 1.0F, z1 = 2.0F;
  Material material;
};

struct RoomOptions {
  Rgb wall;
  Rgb ceiling;
  Rgb window;                 // what is seen through a window; brighter than 1 at day
  bool windows_emit = false;  // shown at full brightness whatever the light inside
  float height = 3.0F;
};

class Room {
 public:
  static constexpr int walls = 4;  // +x, -x, +y, -y
  /// Walls stand `margin` metres beyond the carpet's half sizes.
  void build(float half_length, float half_width, const float (&margin)[walls], const RoomOptions& options,
             std::uint64_t seed);
  /// Where a ray from inside meets wall or ceiling: distance, colour before light, and whether it shines by itself.
  struct Hit {
    float t = 0.0F;
    int face = 0;  // 0..3 walls, 4 ceiling
    Rgb color;
    bool emits = false;
  };
  [[nodiscard]] bool contains(float x, float y) const { return x < at_[0] && x > at_[1] && y < at_[2] && y > at_[3]; }
  /// Distance and face alone.
  void hit(const Vec3& origin, const Vec3& direction, Hit& out) const;
  void paint(const Vec3& origin, const Vec3& direction, Hit& io) const;
  /// True when the straight way from a point along `direction` leaves the room through window glass.
  [[nodiscard]] bool through_window(const Vec3& origin, const Vec3& direction) const;
  [[nodiscard]] float wall_at(int wall) const { return at_[static_cast<std::size_t>(wall)]; }

 private:
  void furnish(int wall, std::uint64_t seed);
  [[nodiscard]] static bool on_glass(const WallItem& item, float s, float z);

  RoomOptions options_;
  std::array<float, walls> at_{};  // coordinates of the walls
  std::array<std::vector<WallItem>, walls> items_;
  NoiseTile plaster_;
};

}  // namespace touchline::sim
