// SPDX-License-Identifier: Apache-2.0
// Points on painted lines, whose place on the ground is known.
#include "vision/line_points.h"

#include <doctest/doctest.h>

#include <memory>

#include "tests/support/ascii_image.h"
#include "tests/vision/line_picture.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Found {
  StaticVector<LinePoint, max_line_points> points;
  LinePointCounts counts;
};

std::unique_ptr<Found> find(const Scene& scene, const CameraPose& pose, float line_width) {
  LinePicture picture(scene, pose);
  auto found = std::make_unique<Found>();
  Bits work(LinePicture::w, LinePicture::h);
  found->counts = find_line_points(picture.input(line_width), work.view(), found->points);
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
  REQUIRE(find_line_point(input, at, {ahead.u - at.u, ahead.v - at.v}, point));
  CHECK(math::abs(point.ground.x - 0.9F) < 0.004F);
  CHECK(math::abs(point.dir_x) < 0.05F);
  SUBCASE("across the line the width is wrong") {
    CHECK_FALSE(find_line_point(input, at, {ahead.v - at.v, at.u - ahead.u}, point));
  }
  SUBCASE("beside the mask there is no line, and beyond the picture nothing at all") {
    CHECK_FALSE(find_line_point(input, {at.u, at.v - 40.0F}, {1.0F, 0.0F}, point));
    CHECK_FALSE(find_line_point(input, {-1.0F, 5.0F}, {1.0F, 0.0F}, point));
    CHECK_FALSE(find_line_point(input, {5.0F, 1e12F}, {1.0F, 0.0F}, point));
  }
}

TEST_CASE("of a skeleton that is nothing but clutter not every pixel is asked") {
  LinePicture picture(Scene{}, usual_pose());
  Bits clutter(LinePicture::w, LinePicture::h);
  for (int y = 0; y < clutter.height; y += 2) {
    for (int x = 0; x < clutter.width; x += 2) clutter.view().set(x, y, true);
  }
  LinePointInput input = picture.input(0.05F);
  input.skeleton = clutter.view();
  Bits work(LinePicture::w, LinePicture::h);
  StaticVector<LinePoint, max_line_points> points;
  const LinePointCounts counts = find_line_points(input, work.view(), points);
  CHECK(points.empty());
  CHECK(counts.considered > 100);
  CHECK(counts.considered < 2 * static_cast<int>(max_line_points));  // of 19,200
}
