// SPDX-License-Identifier: Apache-2.0
// A room is an axis-aligned box seen from inside: the ray leaves through the nearest of three planes.
#include "platform/host/sim/room.h"

#include "platform/core/rng.h"

namespace touchline::sim {

void Room::build(float half_length, float half_width, const float (&margin)[walls], const RoomOptions& options,
                 std::uint64_t seed) {
  options_ = options;
  at_ = {half_length + margin[0], -half_length - margin[1], half_width + margin[2], -half_width - margin[3]};
  Rng rng(seed, 2);
  plaster_.generate(rng, 32, 6, 0.8F);
  for (int wall = 0; wall < walls; ++wall) furnish(wall, seed);
}

void Room::furnish(int wall, std::uint64_t seed) {
  Rng rng(seed, 16U + static_cast<std::uint64_t>(wall));
  auto& items = items_[static_cast<std::size_t>(wall)];
  items.clear();
  const bool along_y = wall < 2;
  const float low = along_y ? at_[3] : at_[1];
  const float high = along_y ? at_[2] : at_[0];
  const bool windows = wall == 0 || wall == 2;
  float s = low + rng.uniform(0.4F, 1.2F);
  while (s < high - 1.6F) {
    WallItem item;
    item.s0 = s;
    const float pick = rng.uniform();
    if (windows && pick < 0.65F) {
      item.kind = WallItem::Kind::window;
      item.s1 = s + rng.uniform(1.1F, 1.5F);
      item.z0 = 1.0F;
      item.z1 = math::min(2.3F, options_.height - 0.3F);
    } else if (pick < 0.8F) {
      item.kind = WallItem::Kind::poster;
      item.s1 = s + rng.uniform(0.5F, 0.9F);
      item.z0 = rng.uniform(0.8F, 1.2F);
      item.z1 = item.z0 + rng.uniform(0.7F, 1.0F);
      item.material.pattern = Pattern::poster;
      item.material.color = {rng.uniform(), rng.uniform(), rng.uniform()};
      item.material.second = {rng.uniform(), rng.uniform(), rng.uniform()};
      item.material.seed = rng.next_u32();
    } else {
      item.kind = WallItem::Kind::door;
      item.s1 = s + 0.85F;
      item.z0 = 0.0F;
      item.z1 = 2.0F;
      item.material.color = rgb8(130, 85, 50);
    }
    s = item.s1 + rng.uniform(0.5F, 1.6F);
    items.push_back(item);
  }
}

bool Room::on_glass(const WallItem& item, float s, float z) {
  if (item.kind != WallItem::Kind::window || s < item.s0 || s > item.s1 || z < item.z0 || z > item.z1) return false;
  const float column = (s - item.s0) * 3.0F / (item.s1 - item.s0);
  const float row = (z - item.z0) * 2.0F / (item.z1 - item.z0);
  const float in_column = column - static_cast<float>(floor_int(column));
  const float in_row = row - static_cast<float>(floor_int(row));
  return in_column > 0.06F && in_column < 0.94F && in_row > 0.05F && in_row < 0.95F;
}

void Room::hit(const Vec3& origin, const Vec3& direction, Hit& out) const {
  constexpr float tiny = 1e-6F;
  const float tx = direction.x > tiny    ? (at_[0] - origin.x) / direction.x
                   : direction.x < -tiny ? (at_[1] - origin.x) / direction.x
                                         : 1e9F;
  const float ty = direction.y > tiny    ? (at_[2] - origin.y) / direction.y
                   : direction.y < -tiny ? (at_[3] - origin.y) / direction.y
                                         : 1e9F;
  const float tz = direction.z > tiny ? (options_.height - origin.z) / direction.z : 1e9F;
  out.t = math::min(tx, math::min(ty, tz));
  out.face = out.t == tz ? 4 : out.t == tx ? (direction.x > 0.0F ? 0 : 1) : (direction.y > 0.0F ? 2 : 3);
}

void Room::paint(const Vec3& origin, const Vec3& direction, Hit& io) const {
  const Vec3 p = origin + direction * io.t;
  io.emits = false;
  if (io.face == 4) {
    const float lamp_x = p.x * 0.45F - static_cast<float>(floor_int(p.x * 0.45F));
    const float lamp_y = p.y * 0.4F - static_cast<float>(floor_int(p.y * 0.4F));
    io.emits = lamp_x < 0.27F && lamp_y < 0.5F && cell_random(floor_int(p.x * 0.45F), floor_int(p.y * 0.4F), 5U) < 0.6F;
    io.color = io.emits ? Rgb{1.6F, 1.55F, 1.5F} : options_.ceiling;
    return;
  }
  const float s = io.face < 2 ? p.y : p.x;
  const float shade = 1.0F + 0.05F * plaster_.nearest(s * 40.0F, p.z * 40.0F);
  io.color = options_.wall * (p.z < 0.09F ? 0.25F : shade);
  for (const WallItem& item : items_[static_cast<std::size_t>(io.face)]) {
    if (s < item.s0 || s > item.s1 || p.z < item.z0 || p.z > item.z1) continue;
    if (item.kind == WallItem::Kind::window) {
      const bool glass = on_glass(item, s, p.z);
      io.color = glass ? options_.window : rgb8(200, 200, 195);
      io.emits = glass && options_.windows_emit;
    } else {
      io.color = surface_color(item.material, s - item.s0, p.z - item.z0);
    }
    return;
  }
}

bool Room::through_window(const Vec3& origin, const Vec3& direction) const {
  Hit h;
  hit(origin, direction, h);
  if (h.face == 4) return false;
  const Vec3 p = origin + direction * h.t;
  const float s = h.face < 2 ? p.y : p.x;
  for (const WallItem& item : items_[static_cast<std::size_t>(h.face)]) {
    if (on_glass(item, s, p.z)) return true;
  }
  return false;
}

}  // namespace touchline::sim
