// SPDX-License-Identifier: Apache-2.0
// One ray a grid node, shared by the four blocks around it: 1,300 rays a frame at 320x240. Nothing is kept between
// frames, because the attitude changes with each.
#include "vision/line_width_table.h"

#include <array>
#include <cassert>

#include "platform/core/elementary.h"
#include "vision/image/frame.h"

namespace touchline {
namespace {

// The working image is never wider than the camera's.
constexpr int max_nodes = max_frame_width / width_block_px + 1;

struct Node {
  Vec3 ray;
  bool valid = false;
};
using NodeRow = std::array<Node, max_nodes>;

/// A ray in the robot's axes, and how it changes per working pixel.
struct RaySlope {
  Vec3 ray, by_u, by_v;
};

struct Grid {
  const GroundProjection& projection;
  float scale_u, scale_v;  // camera pixels a working pixel

  [[nodiscard]] bool ray_at(float u, float v, Vec3& ray) const {
    return projection.robot_ray({u * scale_u, v * scale_v}, ray);
  }
};

Vec3 weighted(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, float c_sign, float d_sign, float scale) {
  return {(a.x + b.x + c_sign * c.x + d_sign * d.x) * scale, (a.y + b.y + c_sign * c.y + d_sign * d.y) * scale,
          (a.z + b.z + c_sign * c.z + d_sign * d.z) * scale};
}

/// From a block's four corners.
RaySlope from_corners(const Node* top, const Node* bottom) {
  constexpr float per_pixel = 0.5F / static_cast<float>(width_block_px);
  RaySlope s;
  s.ray = weighted(top[0].ray, top[1].ray, bottom[0].ray, bottom[1].ray, 1.0F, 1.0F, 0.25F);
  s.by_u = weighted(top[1].ray, bottom[1].ray, top[0].ray, bottom[0].ray, -1.0F, -1.0F, per_pixel);
  s.by_v = weighted(bottom[0].ray, bottom[1].ray, top[0].ray, top[1].ray, -1.0F, -1.0F, per_pixel);
  return s;
}

/// From the block's centre alone, for blocks that the lens's edge cuts; false when the centre lies outside.
bool from_centre(const Grid& grid, float u, float v, RaySlope& s) {
  Vec3 right, below;
  if (!grid.ray_at(u, v, s.ray) || !grid.ray_at(u + 1.0F, v, right) || !grid.ray_at(u, v + 1.0F, below)) return false;
  s.by_u = {right.x - s.ray.x, right.y - s.ray.y, right.z - s.ray.z};
  s.by_v = {below.x - s.ray.x, below.y - s.ray.y, below.z - s.ray.z};
  return true;
}

/// Width in 1/16 working pixel: the line's width over the metres of ground that one pixel of the row (column) covers.
std::uint16_t extent(const Vec3& ray, const Vec3& change, float height, float line_width_m) {
  const float reach = height / -ray.z;
  const float slant = change.z / ray.z;
  const float metres = reach * math::hypot(change.x - ray.x * slant, change.y - ray.y * slant);
  const float sixteenths = 16.0F * line_width_m;
  if (!(sixteenths >= metres)) return 0;
  if (sixteenths >= 65535.0F * metres) return 65535;
  return static_cast<std::uint16_t>(sixteenths / metres + 0.5F);
}

LineWidth width_of(const RaySlope& s, const GroundProjection& projection, float line_width_m) {
  GroundPoint unused;
  if (!projection.intersect_ground(s.ray, unused)) return {};
  const float height = projection.pose().height;
  return {extent(s.ray, s.by_u, height, line_width_m), extent(s.ray, s.by_v, height, line_width_m)};
}

void fill_nodes(const Grid& grid, float v, int count, NodeRow& row) {
  for (int i = 0; i < count; ++i) {
    Node& node = row[static_cast<std::size_t>(i)];
    node.valid = grid.ray_at(static_cast<float>(i * width_block_px), v, node.ray);
  }
}

}  // namespace

void make_line_width_table(const GroundProjection& projection, int frame_width, int frame_height, int work_width,
                           int work_height, float line_width_m, ImageView<LineWidth> table) {
  assert(table.width < max_nodes);
  const Grid grid{projection, static_cast<float>(frame_width) / static_cast<float>(work_width),
                  static_cast<float>(frame_height) / static_cast<float>(work_height)};
  std::array<NodeRow, 2> rows{};
  fill_nodes(grid, 0.0F, table.width + 1, rows[0]);
  for (int y = 0; y < table.height; ++y) {
    const NodeRow& top = rows[static_cast<std::size_t>(y % 2)];
    NodeRow& bottom = rows[static_cast<std::size_t>((y + 1) % 2)];
    fill_nodes(grid, static_cast<float>((y + 1) * width_block_px), table.width + 1, bottom);
    for (int x = 0; x < table.width; ++x) {
      const Node* above = &top[static_cast<std::size_t>(x)];
      const Node* below = &bottom[static_cast<std::size_t>(x)];
      RaySlope s;
      bool inside = true;
      if (above[0].valid && above[1].valid && below[0].valid && below[1].valid) {
        s = from_corners(above, below);
      } else {
        constexpr float half = 0.5F * static_cast<float>(width_block_px);
        inside = from_centre(grid, static_cast<float>(x * width_block_px) + half,
                             static_cast<float>(y * width_block_px) + half, s);
      }
      table.at(x, y) = inside ? width_of(s, projection, line_width_m) : LineWidth{};
    }
  }
}

}  // namespace touchline
