// SPDX-License-Identifier: Apache-2.0
#include "tests/vision/drawn_ground.h"

#include <doctest/doctest.h>

#include "tests/support/paper_lens.h"
#include "tests/support/thinning_memory.h"
#include "vision/image/thinning.h"

namespace touchline::test {
namespace {

bool on_line(const GroundPoint& p, const DrawnLine& line, float half_width) {
  const float dx = line.b.x - line.a.x, dy = line.b.y - line.a.y;
  const float length = math::hypot(dx, dy);
  const float along = ((p.x - line.a.x) * dx + (p.y - line.a.y) * dy) / length;
  const float across = ((p.x - line.a.x) * dy - (p.y - line.a.y) * dx) / length;
  return along >= -half_width && along <= length + half_width && math::abs(across) <= half_width;
}

bool on_circle(const GroundPoint& p, const DrawnCircle& circle, float half_width) {
  const float dx = p.x - circle.centre.x, dy = p.y - circle.centre.y;
  const float angle = math::atan2(dy, dx);
  return math::abs(math::hypot(dx, dy) - circle.radius) <= half_width && angle >= circle.from && angle <= circle.to;
}

/// Drawn with 4x4 samples a pixel, as area weighting would: a pixel is white when most of it is.
bool is_white(const Scene& scene, const GroundProjection& projection, int x, int y) {
  int white = 0;
  for (int i = 0; i < 16; ++i) {
    const float u = (static_cast<float>(x) + (static_cast<float>(i % 4) + 0.5F) / 4.0F) * 752.0F / 320.0F;
    const float v = (static_cast<float>(y) + (static_cast<float>(i / 4) + 0.5F) / 4.0F) * 2.0F;
    GroundPoint p;
    if (!projection.ground({u, v}, p) || math::hypot(p.x, p.y) > 5.0F) continue;
    bool hit = false;
    for (const DrawnLine& line : scene.lines) hit = hit || on_line(p, line, 0.5F * scene.line_width);
    for (const DrawnCircle& circle : scene.circles) hit = hit || on_circle(p, circle, 0.5F * scene.line_width);
    white += hit ? 1 : 0;
  }
  return white >= 6;
}

}  // namespace

Seen::Seen(const Scene& scene, float circle_radius)
    : mask(320, 240), carpet(320, 240), grid(static_cast<std::size_t>(ray_columns(320) * ray_rows(240))) {
  const Lens lens = paper_lens();
  projection = GroundProjection(lens, {0.0F, 0.0F, 0.58F, 0.0F, radians(scene.pitch_deg), radians(scene.roll_deg)});
  const RayGridView view{grid, ray_columns(320), ray_rows(240)};
  make_ray_grid(lens, 752, 480, 320, 240, view);
  rays = std::make_unique<WorkRays>(projection, view, 752, 480, 320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      mask.view().set(x, y, is_white(scene, projection, x, y));
      GroundPoint p;
      carpet.view().set(x, y, projection.ground({static_cast<float>(x) * 2.35F, static_cast<float>(y) * 2.0F}, p));
    }
  }
  skeleton = mask;
  test::OwnThinningMemory thinning(320, 240);
  (void)thin(skeleton.view(), thinning.memory());
  const GraphMemory memory = storage->memory();
  SkeletonIndex index(memory.index);
  REQUIRE(index.build(skeleton.view()));
  const DigestionResult digested = digest(index, {5, 1, 10, 100}, memory.digestion);
  graph = build_node_graph(index, digested.major_nodes, {}, {6}, memory.graph);
  std::vector<std::uint8_t> done(graph.graph.edges.size());
  find_line_segments(graph.graph, *rays, {mask.view(), carpet.view(), carpet.view(), {}}, {scene.line_width, 6.0F},
                     done, *lines);
  if (circle_radius > 0.0F) {
    features->has_circle = find_circle(*lines, *rays, {circle_radius, scene.line_width}, circle_work, features->circle);
  }
  const SeenCircle seen{features->circle, circle_work.seen, circle_radius};
  (void)find_junctions(*lines, features->has_circle ? &seen : nullptr, *rays,
                       {mask.view(), carpet.view(), carpet.view(), {}}, {scene.line_width, 6.0F}, *junction_work,
                       *features);
}

int Seen::count(JunctionType type) const {
  int n = 0;
  for (const Junction& j : features->junctions) n += j.type == type ? 1 : 0;
  return n;
}

const Junction* Seen::nearest(JunctionType type, const GroundPoint& p) const {
  const Junction* best = nullptr;
  float nearest = 0.3F;
  for (const Junction& j : features->junctions) {
    const float d = math::hypot(j.ground.x - p.x, j.ground.y - p.y);
    if (j.type != type || d > nearest) continue;
    nearest = d;
    best = &j;
  }
  return best;
}

float Seen::pixels_off(const Junction& j, const GroundPoint& truth) const {
  PixelPoint p;
  REQUIRE(projection.pixel(truth, p));
  return math::hypot(p.u - j.pixel.u, p.v - j.pixel.v);
}

bool Seen::rejected(JunctionRejection reason, const GroundPoint& near) const {
  PixelPoint p;
  REQUIRE(projection.pixel(near, p));
  for (const RejectedJunction& r : features->rejections) {
    if (r.reason == reason && math::hypot(p.u - r.pixel.u, p.v - r.pixel.v) < 12.0F) return true;
  }
  return false;
}

}  // namespace touchline::test
