// SPDX-License-Identifier: Apache-2.0
// Points on painted lines, whose place on the ground is known.
#include "vision/line_points.h"

#include <doctest/doctest.h>

#include <array>
#include <memory>
#include <vector>

#include "tests/support/ascii_image.h"
#include "tests/vision/painted_field.h"
#include "vision/image/bit_ops.h"
#include "vision/image/thinning.h"

using namespace touchline;
using namespace touchline::test;

namespace {

constexpr int w = 320, h = 240;

struct Found {
  StaticVector<LinePoint, max_line_points> points;
  LinePointCounts counts;
};

/// Line mask and skeleton straight from the picture: what is brighter than half way between carpet and white.
std::unique_ptr<Found> find(const Scene& scene, const CameraPose& pose, float line_width) {
  const GroundProjection projection(test::paper_lens(), pose);
  WorkImage image = work_image(paint(scene, projection));
  Bits mask(w, h);
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      GroundPoint g;
      const PixelPoint pixel{(static_cast<float>(x) + 0.5F) * 2.35F, (static_cast<float>(y) + 0.5F) * 2.0F};
      if (!projection.ground(pixel, g) || math::hypot(g.x, g.y) > 3.0F) continue;
      mask.view().set(x, y, image.y[static_cast<std::size_t>(y * w + x)] > 140);
    }
  }
  Bits skeleton = mask;
  std::array<ThinningScratch, static_cast<std::size_t>(thinning_scratch_size(h))> scratch{};
  thin(skeleton.view(), scratch);
  auto found = std::make_unique<Found>();
  Bits work(w, h);
  std::vector<Vec3> corners(static_cast<std::size_t>(ray_columns(w) * ray_rows(h)));
  const RayGridView grid{corners, ray_columns(w), ray_rows(h)};
  make_ray_grid(test::paper_lens(), 752, 480, w, h, grid);
  const WorkRays rays(projection, grid, 752, 480, w, h);
  const LinePointInput input{image.view().y, skeleton.view(), mask.view(), rays, line_width, 6.0F};
  found->counts = find_line_points(input, work.view(), found->points);
  return found;
}

}  // namespace

TEST_CASE("points lie on the middle of the line on the ground, not of its picture") {
  // A line across, 0.6 m ahead: 16 working pixels wide in the middle of the picture, and nearer ground looks larger.
  for (const float x : {0.5F, 0.9F, 1.6F, 2.4F}) {
    Scene scene;
    scene.stripes = {{{x, -4.0F}, {x, 4.0F}, 0.10F, line_white}};
    const auto found = find(scene, usual_pose(), 0.10F);
    CAPTURE(x);
    REQUIRE(found->points.size() > 60);
    float worst = 0.0F, sum = 0.0F, turned = 0.0F;
    for (const LinePoint& p : found->points.span()) {
      worst = math::max(worst, math::abs(p.ground.x - x) / math::max(p.sigma, 0.005F));
      sum += p.ground.x - x;
      turned += math::asin(p.dir_x);
    }
    CHECK(turned / static_cast<float>(found->points.size()) < 0.05F + 0.03F * x);
    CHECK(worst < 0.75F);  // of a working pixel
    CHECK(math::abs(sum / static_cast<float>(found->points.size())) < 0.004F + 0.002F * x * x);
  }
}

TEST_CASE("each point carries its pixel, the length it stands for and what a pixel means there") {
  Scene scene;
  scene.stripes = {{{0.3F, 0.4F}, {2.5F, 0.4F}, 0.10F, line_white}};
  const auto found = find(scene, usual_pose(), 0.10F);
  REQUIRE(found->points.size() > 30);
  const GroundProjection projection(test::paper_lens(), usual_pose());
  float length = 0.0F;
  for (const LinePoint& p : found->points.span()) {
    GroundPoint by_pixel;
    REQUIRE(projection.ground(p.pixel, by_pixel));
    CHECK(math::hypot(by_pixel.x - p.ground.x, by_pixel.y - p.ground.y) < 5e-3F);
    CHECK(p.sigma > 0.002F);
    CHECK(p.sigma < 0.1F);
    length += p.length;
  }
  CHECK(length == doctest::Approx(2.2F).epsilon(0.25));
}

TEST_CASE("a stripe of another width makes no points, and the reason is counted") {
  Scene scene;
  scene.stripes = {{{0.9F, -4.0F}, {0.9F, 4.0F}, 0.10F, line_white}};
  const auto thin_field = find(scene, usual_pose(), 0.05F);
  CHECK(thin_field->counts.wrong_width > 60);
  // Only where a line of this field is thinner than three pixels, blur hides the difference.
  for (const LinePoint& p : thin_field->points.span()) CHECK(p.sigma > 0.015F);
  const auto wide_field = find(scene, usual_pose(), 0.25F);
  CHECK(wide_field->points.size() < 10);
  CHECK(wide_field->counts.wrong_width > 60);
}

TEST_CASE("no skeleton, no points") {
  const auto found = find(Scene{}, usual_pose(), 0.10F);
  CHECK(found->points.empty());
  CHECK(found->counts.considered == 0);
}
