// SPDX-License-Identifier: Apache-2.0
#include "platform/host/sim/renderer.h"

#include <algorithm>

namespace touchline::sim {
namespace {

constexpr float nowhere = 1e6F;  // ground coordinate of a ray at or above the horizon
constexpr float largest_footprint = 4.0F;
constexpr float rim_softness = 160.0F;  // the image circle's edge, in 1 / cosine

}  // namespace

void SimRenderer::Row::resize(int width) {
  for (auto* v : {&x, &y, &z, &ground_x, &ground_y}) v->resize(static_cast<std::size_t>(width));
}

void SimRenderer::set_lens(const Lens& lens, int width, int height) {
  map_.build(lens, width, height);
  light_.resize(width, height);
  identity_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  for (Row& row : rows_) row.resize(width);
}

void SimRenderer::trace_row(int y, Row& row) const {
  const float* ux = map_.x(y);
  const float* uy = map_.y(y);
  const float* uz = map_.z(y);
  const auto& m = rotation_.m;
  const int last = map_.last(y);
  for (int i = map_.first(y); i < last; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const float dx = m[0][0] * ux[i] + m[0][1] * uy[i] + m[0][2] * uz[i];
    const float dy = m[1][0] * ux[i] + m[1][1] * uy[i] + m[1][2] * uz[i];
    const float dz = m[2][0] * ux[i] + m[2][1] * uy[i] + m[2][2] * uz[i];
    const float t = dz < -1e-4F ? -origin_.z / dz : nowhere;
    row.x[k] = dx;
    row.y[k] = dy;
    row.z[k] = dz;
    row.ground_x[k] = origin_.x + dx * t;
    row.ground_y[k] = origin_.y + dy * t;
  }
}

void SimRenderer::find_candidates(const Scene& scene) {
  struct Cone {
    Vec3 axis;
    float cosine, sine;
  };
  std::vector<Cone> cones;
  bounds_.clear();
  for (const Solid& s : scene.solids()) {
    const Vec3 to = s.centre - origin_;
    const float distance = square_root(dot(to, to));
    bounds_.push_back({to, dot(to, to) - s.bound * s.bound * 1.0001F});
    const float sine = distance <= s.bound ? 2.0F : s.bound / distance;
    const float cosine = sine > 1.0F ? -2.0F : square_root(1.0F - sine * sine);
    cones.push_back({multiply_transposed(rotation_, to * (1.0F / math::max(distance, 1e-6F))), cosine, sine});
  }
  tile_start_.clear();
  tile_solids_.clear();
  for (const TileCone& tile : map_.tiles()) {
    tile_start_.push_back(static_cast<std::uint32_t>(tile_solids_.size()));
    if (tile.cosine > 1.5F) continue;
    for (std::size_t i = 0; i < cones.size(); ++i) {
      const Cone& c = cones[i];
      const float limit = c.cosine < -1.0F ? -1.0F : tile.cosine * c.cosine - tile.sine * c.sine;
      if (dot(tile.axis, c.axis) >= limit) tile_solids_.push_back(static_cast<std::uint16_t>(i));
    }
  }
  tile_start_.push_back(static_cast<std::uint32_t>(tile_solids_.size()));
}

Footprint SimRenderer::footprint(const Row& row, const Row& below, int x) const {
  const auto k = static_cast<std::size_t>(x);
  const auto limit = [](float v) { return math::clamp(0.5F * v, -largest_footprint, largest_footprint); };
  Footprint f;
  f.ux = limit(row.ground_x[k + 1] - row.ground_x[k]);
  f.uy = limit(row.ground_y[k + 1] - row.ground_y[k]);
  f.vx = limit(below.ground_x[k] - row.ground_x[k]);
  f.vy = limit(below.ground_y[k] - row.ground_y[k]);
  return f;
}

Rgb SimRenderer::shade(const Scene& scene, int tile, const Vec3& direction, const Footprint& pixel,
                       Identity& identity) const {
  const float ground = direction.z < -1e-4F ? -origin_.z / direction.z : nowhere;
  const float ground_x = origin_.x + direction.x * ground;
  const float ground_y = origin_.y + direction.y * ground;
  Room::Hit room;
  room.t = nowhere;
  if (!scene.room().contains(ground_x, ground_y)) scene.room().hit(origin_, direction, room);
  float nearest = math::min(ground, room.t);
  SolidHit best;
  SolidHit hit;
  const Solid* seen = nullptr;
  const auto solids = scene.solids();
  const auto first = tile_start_[static_cast<std::size_t>(tile)];
  const auto last = tile_start_[static_cast<std::size_t>(tile) + 1U];
  for (auto i = first; i < last; ++i) {
    const Bound& bound = bounds_[tile_solids_[i]];
    const float along = dot(bound.to, direction);
    if (bound.clear2 > 0.0F && (along < 0.0F || along * along < bound.clear2)) continue;
    const Solid& solid = solids[tile_solids_[i]];
    if (!intersect(solid, origin_, direction, nearest, hit)) continue;
    nearest = hit.t;
    best = hit;
    seen = &solid;
    identity = static_cast<Identity>(8 + tile_solids_[i] * 8 + hit.face);
  }
  if (seen != nullptr) return scene.lit_solid(surface_color(seen->material, best.s, best.z), best.normal);
  if (ground <= room.t) {
    identity = 0;
    return scene.lit_ground(scene.ground().color(ground_x, ground_y, pixel), ground_x, ground_y);
  }
  identity = static_cast<Identity>(1 + room.face);
  scene.room().paint(origin_, direction, room);
  return scene.lit_wall(room);
}

void SimRenderer::store(int x, int y, const Rgb& color, float cosine) {
  const float rim = math::clamp((cosine - map_.min_cosine()) * rim_softness, 0.0F, 1.0F);
  const float lost = effects_.vignetting * (1.0F - cosine) / (1.0F - map_.min_cosine());
  const float share = rim * (1.0F - lost);
  light_.row(0, y)[x] = color.r * share;
  light_.row(1, y)[x] = color.g * share;
  light_.row(2, y)[x] = color.b * share;
}

void SimRenderer::shade_row(const Scene& scene, int y, const Row& row, const Row& below) {
  const int first = map_.first(y);
  const int last = map_.last(y);
  const std::size_t base = static_cast<std::size_t>(y) * static_cast<std::size_t>(map_.width());
  for (int c = 0; c < 3; ++c) std::fill_n(light_.row(c, y), map_.width(), 0.0F);
  std::fill_n(identity_.begin() + static_cast<std::ptrdiff_t>(base), map_.width(), Identity{7});
  // At the rim a neighbour may see nothing; the nearest pixel with both neighbours has nearly the same footprint.
  const int other = y + 1 < map_.height() ? y + 1 : y - 1;
  const int low = std::max(first, map_.first(other));
  const int high = std::max(std::min(last, map_.last(other)) - 2, low);
  const bool alone = std::min(last, map_.last(other)) - low < 2;
  const int tile_row = y / LensMap::tile * map_.tiles_x();
  const float* cosine = map_.z(y);
  for (int x = first; x < last; ++x) {
    const auto k = static_cast<std::size_t>(x);
    Identity identity = 0;
    const Footprint pixel = alone ? Footprint{} : footprint(row, below, std::clamp(x, low, high));
    const Rgb color = shade(scene, tile_row + x / LensMap::tile, {row.x[k], row.y[k], row.z[k]}, pixel, identity);
    identity_[base + k] = identity;
    store(x, y, color, cosine[x]);
  }
}

void SimRenderer::render(const Scene& scene, const Pose2& robot, const CameraPose& camera, const ImageEffects& effects,
                         std::uint64_t noise_seed, std::vector<std::uint8_t>& rgb) {
  effects_ = effects;
  rotation_ = multiply(rotation_z(robot.theta), robot_from_camera(camera));
  const FieldPoint at = to_field(robot, GroundPoint{camera.x, camera.y});
  origin_ = {at.x, at.y, camera.height};
  find_candidates(scene);
  const int height = map_.height();
  const std::size_t stride = static_cast<std::size_t>(map_.width()) * 3U;
  rgb.resize(stride * static_cast<std::size_t>(height));
  developer_.begin(light_, effects, noise_seed);
  trace_row(0, rows_[0]);
  // Row by row through all three steps, so that a row is still in the cache: edges wait for the row below, the blur for
  // two finished rows.
  constexpr int behind = 1 + Developer::rows_below;
  for (int y = 0; y < height + behind; ++y) {
    Row& row = rows_[y & 1];
    Row& below = rows_[(y + 1) & 1];
    if (y + 1 < height) trace_row(y + 1, below);
    if (y < height) shade_row(scene, y, row, below);
    if (effects.supersample_edges && y >= 2 && y < height) supersample_row(scene, y - 1);
    const int ready = y - behind;
    if (ready >= 0) developer_.develop(light_, ready, &rgb[stride * static_cast<std::size_t>(ready)]);
  }
}

bool SimRenderer::differs(int x, int y) const {
  const auto at = [&](int i, int j) {
    return identity_[static_cast<std::size_t>(j) * static_cast<std::size_t>(map_.width()) +
                     static_cast<std::size_t>(i)];
  };
  const Identity own = at(x, y);
  return at(x - 1, y) != own || at(x + 1, y) != own || at(x, y - 1) != own || at(x, y + 1) != own;
}

Rgb SimRenderer::supersampled(const Scene& scene, int x, int y) const {
  const auto camera_ray = [&](int i, int j) { return Vec3{map_.x(j)[i], map_.y(j)[i], map_.z(j)[i]}; };
  const Vec3 centre = multiply(rotation_, camera_ray(x, y));
  const Vec3 right = multiply(rotation_, camera_ray(x + 1, y) - camera_ray(x - 1, y)) * 0.125F;
  const Vec3 down = multiply(rotation_, camera_ray(x, y + 1) - camera_ray(x, y - 1)) * 0.125F;
  // One pixel's footprint, halved for a quarter of its area.
  const float t = centre.z < -1e-3F ? -origin_.z / centre.z : 0.0F;
  const auto on_ground = [&](const Vec3& step, float& px, float& py) {
    px = (step.x - centre.x * step.z / math::min(centre.z, -1e-3F)) * t;
    py = (step.y - centre.y * step.z / math::min(centre.z, -1e-3F)) * t;
  };
  Footprint f;
  on_ground(right, f.ux, f.uy);
  on_ground(down, f.vx, f.vy);
  const int tile = y / LensMap::tile * map_.tiles_x() + x / LensMap::tile;
  Rgb sum;
  for (int k = 0; k < 4; ++k) {
    Identity ignored = 0;
    const Vec3 ray = centre + right * ((k & 1) != 0 ? 1.0F : -1.0F) + down * ((k & 2) != 0 ? 1.0F : -1.0F);
    sum = sum + shade(scene, tile, ray, f, ignored);
  }
  return sum * 0.25F;
}

void SimRenderer::supersample_row(const Scene& scene, int y) {
  const int first = std::max({map_.first(y - 1), map_.first(y) + 1, map_.first(y + 1), 1});
  const int last = std::min({map_.last(y - 1), map_.last(y) - 1, map_.last(y + 1), map_.width() - 1});
  for (int x = first; x < last; ++x) {
    if (differs(x, y)) store(x, y, supersampled(scene, x, y), map_.z(y)[x]);
  }
}

}  // namespace touchline::sim
