// SPDX-License-Identifier: Apache-2.0
// One hall with one field: everything a camera could see, and the light on it. Built from a seed.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "loc/field.h"
#include "platform/host/sim/ground.h"
#include "platform/host/sim/light_map.h"
#include "platform/host/sim/room.h"
#include "platform/host/sim/solids.h"

namespace touchline::sim {

enum class Light : std::uint8_t { even, dim_warm, low_sun };

struct SceneOptions {
  FieldDimensions field;
  std::uint64_t seed = 1;
  Light light = Light::even;
  GroundOptions ground;
  bool yellow_posts = true;  // else white
  bool ball = true;
  bool orange_ball = true;  // else white
  bool clutter = true;      // people, boards, chairs around the carpet
  int robots = 3;           // other robots on the field
  float robot_height = 0.6F;
  bool own_feet = false;  // the robot sees its own feet
  float exposure = 1.0F;
};

/// A plausible scene: one of several carpets, any light, three to no robots; all from the seed.
SceneOptions random_scene(const FieldDimensions& field, std::uint64_t seed);

class Scene {
 public:
  void build(const SceneOptions& options);
  /// Where the other robots and the ball are in this frame. Fewer or more robots than before are allowed.
  void set_moving(std::span<const Pose2> robots, float phase, const FieldPoint& ball);
  /// The robot's own feet, at its pose; only with `own_feet`.
  void set_own_pose(const Pose2& pose, float phase);

  [[nodiscard]] const SceneOptions& options() const { return options_; }
  [[nodiscard]] const Ground& ground() const { return ground_; }
  [[nodiscard]] const Room& room() const { return room_; }
  [[nodiscard]] std::span<const Solid> solids() const { return solids_; }
  /// The colour that a surface of `albedo` shows under the light that reaches the ground there.
  [[nodiscard]] Rgb lit_ground(const Rgb& albedo, float x, float y) const {
    return albedo * (ambient_ + direct_ * light_map_.at(x, y));
  }
  [[nodiscard]] Rgb lit_solid(const Rgb& albedo, const Vec3& normal) const;
  [[nodiscard]] Rgb lit_wall(const Room::Hit& hit) const {
    return hit.emits ? hit.color * exposure_ : hit.color * indoor_;
  }
  /// Is the straight way from a to b blocked by a solid (own feet included)?
  [[nodiscard]] bool occluded(const Vec3& from, const Vec3& to) const;

 private:
  void set_light();
  void add_clutter(Rng& rng, const float (&margin)[Room::walls]);

  SceneOptions options_;
  Ground ground_;
  Room room_;
  LightMap light_map_;
  Rgb ambient_, direct_, indoor_;
  float exposure_ = 1.0F;
  Vec3 to_sun_;
  std::vector<Solid> still_;   // goals and clutter
  std::vector<Solid> moving_;  // robots, ball
  std::vector<Solid> feet_;
  std::vector<Solid> solids_;  // all of them
};

}  // namespace touchline::sim
