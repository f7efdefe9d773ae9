// SPDX-License-Identifier: Apache-2.0
// Ray against capsule, sphere and box, from the quadratic equation of each and the slabs of the box.
#include "platform/host/sim/solids.h"

namespace touchline::sim {
namespace {

bool hit_sphere(const Vec3& centre, float radius, const Vec3& origin, const Vec3& direction, float& t) {
  const Vec3 from = origin - centre;
  const float b = dot(from, direction);
  const float c = dot(from, from) - radius * radius;
  const float root = b * b - c;
  if (root < 0.0F) return false;
  t = -b - square_root(root);
  return t > 0.0F;
}

bool hit_capsule(const Solid& s, const Vec3& origin, const Vec3& direction, float& t, Vec3& normal) {
  const Vec3 axis = s.b - s.a;
  const Vec3 from = origin - s.a;
  const float axis2 = dot(axis, axis);
  const float along_d = dot(axis, direction);
  const float along_o = dot(axis, from);
  // The part of the ray across the axis, scaled by axis^2 so that nothing is divided.
  const float a = axis2 - along_d * along_d;
  const float b = axis2 * dot(from, direction) - along_o * along_d;
  const float c = axis2 * (dot(from, from) - s.radius * s.radius) - along_o * along_o;
  const float root = b * b - a * c;
  if (root < 0.0F) return false;
  float place = along_o;
  if (a > 1e-9F) {
    t = (-b - square_root(root)) / a;
    place = along_o + t * along_d;
    if (t > 0.0F && place >= 0.0F && place <= axis2) {
      normal = (from + direction * t - axis * (place / axis2)) * (1.0F / s.radius);
      return true;
    }
  }
  const Vec3 end = place <= 0.0F ? s.a : s.b;
  if (!hit_sphere(end, s.radius, origin, direction, t)) return false;
  normal = (origin + direction * t - end) * (1.0F / s.radius);
  return true;
}

bool hit_box(const Solid& s, const Vec3& origin, const Vec3& direction, SolidHit& hit) {
  const auto to_local = [&](const Vec3& v) {
    return Vec3{s.cos_yaw * v.x + s.sin_yaw * v.y, -s.sin_yaw * v.x + s.cos_yaw * v.y, v.z};
  };
  const Vec3 o = to_local(origin - s.a);
  const Vec3 d = to_local(direction);
  const float os[3] = {o.x, o.y, o.z};
  const float ds[3] = {d.x, d.y, d.z};
  const float half[3] = {s.b.x, s.b.y, s.b.z};
  float enter = -1e30F;
  float leave = 1e30F;
  int face = 0;
  for (int i = 0; i < 3; ++i) {
    const float step = math::abs(ds[i]) < 1e-9F ? 1e-9F : ds[i];
    const float near = (-os[i] - (step > 0.0F ? half[i] : -half[i])) / step;
    const float far = (-os[i] + (step > 0.0F ? half[i] : -half[i])) / step;
    if (near > enter) {
      enter = near;
      face = i * 2 + (step > 0.0F ? 0 : 1);
    }
    leave = math::min(leave, far);
  }
  if (enter > leave || enter <= 0.0F) return false;
  hit.t = enter;
  hit.face = face;
  const float sign = (face & 1) != 0 ? 1.0F : -1.0F;
  const Vec3 at = o + d * enter;
  if (face < 2) hit.normal = {sign * s.cos_yaw, sign * s.sin_yaw, 0.0F};
  if (face == 2 || face == 3) hit.normal = {-sign * s.sin_yaw, sign * s.cos_yaw, 0.0F};
  if (face >= 4) hit.normal = {0.0F, 0.0F, sign};
  hit.s = face < 2 ? at.y : at.x;
  hit.z = at.z + s.b.z;
  return true;
}

}  // namespace

Solid make_capsule(const Vec3& a, const Vec3& b, float radius, const Material& material) {
  Solid s;
  s.shape = SolidShape::capsule;
  s.a = a;
  s.b = b;
  s.radius = radius;
  s.material = material;
  s.centre = (a + b) * 0.5F;
  s.bound = square_root(dot(b - a, b - a)) * 0.5F + radius;
  return s;
}

Solid make_sphere(const Vec3& centre, float radius, const Material& material) {
  Solid s;
  s.a = centre;
  s.radius = radius;
  s.material = material;
  s.centre = centre;
  s.bound = radius;
  return s;
}

Solid make_box(const Vec3& centre, const Vec3& half, float yaw, const Material& material) {
  Solid s;
  s.shape = SolidShape::box;
  s.a = centre;
  s.b = half;
  s.cos_yaw = math::cos(yaw);
  s.sin_yaw = math::sin(yaw);
  s.material = material;
  s.centre = centre;
  s.bound = square_root(dot(half, half));
  return s;
}

bool intersect(const Solid& solid, const Vec3& origin, const Vec3& direction, float t_max, SolidHit& hit) {
  const Vec3 to = solid.centre - origin;
  const float along = dot(to, direction);
  const float away2 = dot(to, to) - along * along;
  if (away2 > solid.bound * solid.bound || along < -solid.bound || along - solid.bound > t_max) return false;
  bool found = false;
  if (solid.shape == SolidShape::box) {
    found = hit_box(solid, origin, direction, hit);
    return found && hit.t < t_max;
  }
  float t = 0.0F;
  Vec3 normal;
  if (solid.shape == SolidShape::sphere) {
    found = hit_sphere(solid.a, solid.radius, origin, direction, t);
    if (found) normal = (origin + direction * t - solid.a) * (1.0F / solid.radius);
  } else {
    found = hit_capsule(solid, origin, direction, t, normal);
  }
  if (!found || t >= t_max) return false;
  hit.t = t;
  hit.normal = normal;
  hit.s = normal.x * solid.radius;
  hit.z = origin.z + direction.z * t;
  hit.face = 0;
  return true;
}

Rgb surface_color(const Material& material, float s, float z) {
  switch (material.pattern) {
    case Pattern::plain: return material.color;
    case Pattern::stripes: {
      const float place = s / material.period;
      return place - static_cast<float>(floor_int(place)) < 0.16F ? material.second : material.color;
    }
    case Pattern::text: {  // blocks like letters in a band of words
      if (z < 0.14F || z > 0.26F) return material.color;
      const int word = floor_int(s / 0.45F);
      const int column = floor_int(s / 0.022F);
      if (s / 0.45F - static_cast<float>(word) > 0.75F) return material.color;
      const bool ink = cell_random(column, floor_int(z / 0.03F), material.seed) < 0.55F && column % 4 != 0;
      return ink ? material.second : material.color;
    }
    case Pattern::poster: {
      const float pick = cell_random(floor_int(s / 0.13F), floor_int(z / 0.11F), material.seed);
      if (pick < 0.45F) return material.color;
      if (pick < 0.6F) return material.second;
      return {cell_random(1, floor_int(pick * 97.0F), material.seed), pick * 0.5F,
              cell_random(2, floor_int(pick * 89.0F), material.seed)};
    }
  }
  return material.color;
}

}  // namespace touchline::sim
