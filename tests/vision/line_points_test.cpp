// SPDX-License-Identifier: Apache-2.0
// Points on painted lines, whose place on the ground is known.
#include "vision/line_points.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "platform/core/rng.h"
#include "tests/support/ascii_image.h"
#include "tests/support/kernel_tables.h"
#include "tests/vision/line_picture.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Found {
  StaticVector<LinePoint, max_line_points> points;
  LinePointCounts counts;
};

/// At one place, if there is one.
bool find_one(const LinePointInput& input, const WorkPoint& at, const WorkPoint& direction, LinePoint& point) {
  FoundLinePoints points;
  find_line_points_at(input, {&at, 1}, direction, points);
  if (!points.empty()) point = points[0];
  return !points.empty();
}

std::unique_ptr<Found> find(const Scene& scene, const CameraPose& pose, float line_width, int width = 320,
                            int height = 240) {
  LinePicture picture(scene, pose, width, height);
  auto found = std::make_unique<Found>();
  Bits work(width, height);
  found->counts = find_line_points(picture.input(line_width), work.view(), found->points);
  return found;
}

bool same_bits(float a, float b) { return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b); }
bool same(const LinePoint& a, const LinePoint& b) {
  return same_bits(a.pixel.u, b.pixel.u) && same_bits(a.pixel.v, b.pixel.v) && same_bits(a.ground.x, b.ground.x) &&
         same_bits(a.ground.y, b.ground.y) && same_bits(a.dir_x, b.dir_x) && same_bits(a.dir_y, b.dir_y) &&
         same_bits(a.length, b.length) && same_bits(a.sigma, b.sigma);
}

/// Lines of all directions, to the edges of the picture, then speckles on the luma, on the mask and on the skeleton.
struct RoughInput {
  LinePicture picture;
  Bits mask, skeleton;
  std::vector<std::uint8_t> luma;
  LinePointInput input;

  RoughInput(const Scene& scene, const CameraPose& pose, int w, int h, Rng& rng)
      : picture(scene, pose, w, h), input(picture.input(0.1F)) {
    mask = skeleton = Bits(w, h);
    luma.assign(static_cast<std::size_t>(w * h), 0);
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) {
        mask.view().set(x, y, input.line_mask.get(x, y) != (rng.below(300) == 0));
        skeleton.view().set(x, y, input.skeleton.get(x, y) != (rng.below(150) == 0));
        const int rough = input.luma.row(y)[x] + static_cast<int>(rng.below(41)) - 20;
        luma[static_cast<std::size_t>(y * w + x)] = static_cast<std::uint8_t>(std::clamp(rough, 0, 255));
      }
    }
    input.luma = {luma.data(), w, h, w};
    input.line_mask = mask.view();
    input.skeleton = skeleton.view();
  }
};

}  // namespace

TEST_CASE("every table of kernels gives the same points, bit for bit") {
  Rng rng(3);
  Scene scene;
  scene.stripes = {
      {{-4.0F, -4.0F}, {4.0F, 4.0F}, 0.10F, line_white}, {{-4.0F, 4.0F}, {4.0F, -4.0F}, 0.10F, line_white},
      {{0.3F, -4.0F}, {0.3F, 4.0F}, 0.10F, line_white},  {{0.8F, -4.0F}, {0.8F, 4.0F}, 0.10F, line_white},
      {{-4.0F, 0.5F}, {4.0F, 0.5F}, 0.10F, line_white},  {{-4.0F, -0.7F}, {4.0F, -0.7F}, 0.10F, line_white}};
  // The larger one has windows that are looked at in two parts.
  for (const auto& [width, height] : {std::pair{320, 240}, {320, 240}, {320, 240}, {640, 480}}) {
    CameraPose pose = usual_pose();
    pose.pitch += rng.uniform(-0.3F, 0.5F);
    pose.yaw = rng.uniform(-math::pi, math::pi);
    RoughInput rough(scene, pose, width, height, rng);
    Bits work(width, height);
    const auto first = std::make_unique<Found>();
    rough.input.kernels = word_kernels();
    first->counts = find_line_points(rough.input, work.view(), first->points);
    CHECK(first->points.size() > 50);
    CHECK(first->counts.no_edge > 10);
    CHECK(first->counts.wrong_width > 2);
    for (const Kernels& kernels : runnable_tables()) {
      CAPTURE(kernels.name);
      rough.input.kernels = kernels;
      const auto other = std::make_unique<Found>();
      other->counts = find_line_points(rough.input, work.view(), other->points);
      CHECK(other->counts.considered == first->counts.considered);
      CHECK(other->counts.no_direction == first->counts.no_direction);
      CHECK(other->counts.no_edge == first->counts.no_edge);
      CHECK(other->counts.wrong_width == first->counts.wrong_width);
      REQUIRE(other->points.size() == first->points.size());
      for (std::size_t i = 0; i < first->points.size(); ++i) CHECK(same(other->points[i], first->points[i]));
    }
  }
}

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

TEST_CASE("near lines have as many points in a large picture as in a small one") {
  // A camera low and down, and a line across the feet: at 640x480 it is more than 80 pixels wide.
  CameraPose pose = usual_pose();
  pose.height = 0.20F;
  pose.pitch = radians(45.0F);
  Scene scene;
  scene.stripes = {{{0.10F, -1.0F}, {0.10F, 1.0F}, 0.10F, line_white}};
  const auto metres = [&](int width, int height) {
    const auto found = find(scene, pose, 0.10F, width, height);
    float sum = 0.0F;
    for (const LinePoint& p : found->points.span()) sum += p.length;
    return sum;
  };
  const float small = metres(320, 240);
  CHECK(small > 0.5F);
  CHECK(metres(640, 480) > 0.9F * small);
}

TEST_CASE("no skeleton, no points") {
  const auto found = find(Scene{}, usual_pose(), 0.10F);
  CHECK(found->points.empty());
  CHECK(found->counts.considered == 0);
}

TEST_CASE("with its direction given, a piece too short for the skeleton's axis has a point") {
  Scene scene;
  // A rung of a ladder, from one side 7 cm long.
  scene.stripes = {{{0.6F, 0.0F}, {1.2F, 0.0F}, 0.05F, line_white},
                   {{0.6F, 0.12F}, {1.2F, 0.12F}, 0.05F, line_white},
                   {{0.9F, 0.0F}, {0.9F, 0.12F}, 0.05F, line_white}};
  const auto found = find(scene, usual_pose(), 0.05F);
  REQUIRE_FALSE(found->points.empty());
  for (const LinePoint& p : found->points) CHECK(math::abs(p.dir_x) > 0.9F);
  LinePicture picture(scene, usual_pose());
  const LinePointInput input = picture.input(0.05F);
  WorkPoint at, ahead;
  REQUIRE(input.rays.work_point({0.905F, 0.06F}, 0.0F, at));
  REQUIRE(input.rays.work_point({0.905F, 0.08F}, 0.0F, ahead));
  LinePoint point;
  REQUIRE(find_one(input, at, {ahead.u - at.u, ahead.v - at.v}, point));
  CHECK(math::abs(point.ground.x - 0.9F) < 0.004F);
  CHECK(math::abs(point.dir_x) < 0.05F);
  SUBCASE("across the line the width is wrong") {
    CHECK_FALSE(find_one(input, at, {ahead.v - at.v, at.u - ahead.u}, point));
  }
  SUBCASE("beside the mask there is no line, and beyond the picture nothing at all") {
    CHECK_FALSE(find_one(input, {at.u, at.v - 40.0F}, {1.0F, 0.0F}, point));
    CHECK_FALSE(find_one(input, {-1.0F, 5.0F}, {1.0F, 0.0F}, point));
    CHECK_FALSE(find_one(input, {5.0F, 1e12F}, {1.0F, 0.0F}, point));
  }
}

TEST_CASE("of a skeleton that is nothing but clutter not every pixel is asked") {
  LinePicture picture(Scene{}, usual_pose());
  Bits clutter(picture.w, picture.h);
  for (int y = 0; y < clutter.height; y += 2) {
    for (int x = 0; x < clutter.width; x += 2) clutter.view().set(x, y, true);
  }
  LinePointInput input = picture.input(0.05F);
  input.skeleton = clutter.view();
  Bits work(picture.w, picture.h);
  StaticVector<LinePoint, max_line_points> points;
  const LinePointCounts counts = find_line_points(input, work.view(), points);
  CHECK(points.empty());
  CHECK(counts.considered > 100);
  CHECK(counts.considered < 2 * static_cast<int>(max_line_points));  // of 19,200
}
