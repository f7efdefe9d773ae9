// SPDX-License-Identifier: Apache-2.0
// What stands on and beside the field, made of three shapes: capsules (posts, limbs), spheres (ball, heads) and boxes
// turned about the vertical (boards, robots, furniture). In the field frame, metres.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/host/sim/vec.h"

namespace touchline::sim {

enum class SolidShape : std::uint8_t { capsule, sphere, box };
enum class Pattern : std::uint8_t { plain, stripes, text, poster };

struct Material {
  Rgb color;
  Rgb second;  // of the stripes, letters or patches
  Pattern pattern = Pattern::plain;
  float period = 0.6F;  // of stripes, metres
  std::uint32_t seed = 0;
};

struct Solid {
  SolidShape shape = SolidShape::sphere;
  Vec3 a;               // capsule: one end of the axis; sphere and box: centre
  Vec3 b;               // capsule: other end; box: half sizes
  float radius = 0.0F;  // capsule, sphere
  float cos_yaw = 1.0F;
  float sin_yaw = 0.0F;
  Material material;
  Vec3 centre;  // of the bounding sphere
  float bound = 0.0F;
};

Solid make_capsule(const Vec3& a, const Vec3& b, float radius, const Material& material);
Solid make_sphere(const Vec3& centre, float radius, const Material& material);
Solid make_box(const Vec3& centre, const Vec3& half, float yaw, const Material& material);

struct SolidHit {
  float t = 0.0F;  // along the ray, in lengths of its direction
  Vec3 normal;     // unit, field frame
  float s = 0.0F;  // on the surface, metres: along it
  float z = 0.0F;  // above the solid's foot
  int face = 0;    // tells the faces of a box apart
};

/// The nearest entry of the ray into the solid before `t_max`; false when there is none. `direction` is a unit vector.
bool intersect(const Solid& solid, const Vec3& origin, const Vec3& direction, float t_max, SolidHit& hit);

/// Surface colour at a hit, before light.
Rgb surface_color(const Material& material, float s, float z);

/// A robot of `height` metres at a pose on the field, legs apart by the phase of its step. Appends its parts.
void append_robot(const Pose2& pose, float height, float phase, const Rgb& team, std::uint32_t seed,
                  std::vector<Solid>& out);
void append_person(float x, float y, float facing, std::uint32_t seed, std::vector<Solid>& out);
void append_chair(float x, float y, float facing, std::uint32_t seed, std::vector<Solid>& out);
/// A standing board of `length`, split into pieces so that each has a tight bounding sphere.
void append_board(float x, float y, float facing, float length, float height, const Material& material,
                  std::vector<Solid>& out);
/// A goal with its mouth on x = `goal_x`; posts and bar as capsules.
void append_goal(float goal_x, float width, float height, float diameter, const Rgb& color, std::vector<Solid>& out);

}  // namespace touchline::sim
