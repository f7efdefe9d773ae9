// SPDX-License-Identifier: Apache-2.0
// What is drawn lies where the lens and the camera's pose say, to a small part of a pixel.
#include "platform/host/sim/renderer.h"

#include <doctest/doctest.h>

#include <cmath>

#include "platform/core/hash.h"
#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

struct Picture {
  SimCameraModel camera;
  Lens lens;
  Scene scene;
  SimRenderer renderer;
  std::vector<std::uint8_t> rgb;

  explicit Picture(const char* model, const SceneOptions& options) : camera(*camera_model(model)) {
    REQUIRE(Lens::create(camera.lens, lens) == Status::ok);
    scene.build(options);
    renderer.set_lens(lens, camera.width, camera.height);
  }
  void draw(const Pose2& robot, const CameraPose& pose, const ImageEffects& effects = no_effects()) {
    renderer.render(scene, robot, pose, effects, 1, rgb);
  }
  /// Linear light of the red channel: paint is bright, carpet is dark.
  [[nodiscard]] double red(int x, int y) const {
    const std::size_t i =
        (static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x)) * 3U;
    return rgb[i] * rgb[i] / (255.0 * 255.0);
  }
};

struct Centroid {
  double sum = 0.0, su = 0.0, sv = 0.0;
  void add(double u, double v, double weight) {
    sum += weight;
    su += weight * u;
    sv += weight * v;
  }
  [[nodiscard]] double u() const { return su / sum; }
  [[nodiscard]] double v() const { return sv / sum; }
};

/// The penalty mark's disc of 5 cm by many samples a pixel, through the projection that vision uses.
Centroid mark_share(const GroundProjection& projection, const Pose2& robot, const FieldPoint& mark) {
  PixelPoint centre;
  REQUIRE(projection.pixel(to_ground(robot, mark), centre));
  Centroid c;
  for (float v = centre.v - 12.0F; v < centre.v + 12.0F; v += 0.125F) {
    for (float u = centre.u - 18.0F; u < centre.u + 18.0F; u += 0.125F) {
      GroundPoint g;
      if (!projection.ground({u, v}, g)) continue;
      const FieldPoint p = to_field(robot, g);
      if (std::hypot(p.x - mark.x, p.y - mark.y) < 0.05F)
        c.add(static_cast<double>(u), static_cast<double>(v), 1.0 / 64.0);
    }
  }
  return c;
}

}  // namespace

TEST_CASE("renderer: a penalty mark's centroid is where the lens projects it, for each lens and attitude") {
  Rng rng(21);
  for (const char* model : {"fisheye-185", "fisheye-140", "fisheye-140-kb"}) {
    Picture picture(model, plain_scene(small_field()));
    for (int i = 0; i < 6; ++i) {
      const CameraPose camera{rng.uniform(-0.05F, 0.05F), rng.uniform(-0.05F, 0.05F), 0.58F,
                              rng.uniform(-0.2F, 0.2F),   rng.uniform(0.4F, 0.7F),    rng.uniform(-0.5F, 0.5F)};
      const FieldPoint mark{1.25F, 0.0F};
      const float heading = rng.uniform(-3.0F, 3.0F);
      const Pose2 robot{mark.x - 1.3F * math::cos(heading), mark.y - 1.3F * math::sin(heading), heading};
      picture.draw(robot, camera);
      const Centroid expected = mark_share(GroundProjection(picture.lens, camera), robot, mark);
      PixelPoint centre;
      REQUIRE(GroundProjection(picture.lens, camera).pixel(to_ground(robot, mark), centre));
      const int cx = static_cast<int>(centre.u);
      const int cy = static_cast<int>(centre.v);
      const double carpet = picture.red(cx - 17, cy + 10);
      const double paint = static_cast<double>(rgb8(215, 215, 215).r / rgb8(40, 110, 60).r) * carpet;
      Centroid drawn;
      for (int y = cy - 10; y <= cy + 10; ++y) {
        for (int x = cx - 17; x <= cx + 17; ++x) {
          const double share = (picture.red(x, y) - carpet) / (paint - carpet);
          if (share > 0.03) drawn.add(x + 0.5, y + 0.5, share);
        }
      }
      CHECK(drawn.sum == doctest::Approx(expected.sum).epsilon(0.05));
      CHECK(std::abs(drawn.u() - expected.u()) < 0.06);
      CHECK(std::abs(drawn.v() - expected.v()) < 0.06);
    }
  }
}

TEST_CASE("renderer: a line thinner than a pixel keeps its place and its brightness") {
  SceneOptions options = plain_scene(small_field());
  options.field.line_width = 0.03F;
  options.field.goal_area_depth = 0.0F;
  Picture picture("fisheye-185", options);
  const CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, 0.5F, 0.2F};
  const Pose2 robot{-2.0F, 0.7F, 0.0F};
  picture.draw(robot, camera);
  const GroundProjection projection(picture.lens, camera);
  double off = 0.0;
  double share_of_width = 0.0;
  int places = 0;
  for (float across = 0.2F; across < 0.65F; across += 0.005F) {  // places on the far goal line, 4.4 m ahead
    PixelPoint centre;
    PixelPoint near;
    PixelPoint far;
    const auto seen = [&](float x, PixelPoint& p) {
      return projection.pixel(to_ground(robot, FieldPoint{x, 0.7F + across}), p);
    };
    REQUIRE(seen(2.45F, centre));
    REQUIRE(seen(2.435F, near));
    REQUIRE(seen(2.465F, far));
    const int column = static_cast<int>(centre.u);
    const int row = static_cast<int>(centre.v);
    const double carpet = picture.red(column, row + 3);
    const double paint = static_cast<double>(rgb8(215, 215, 215).r / rgb8(40, 110, 60).r) * carpet;
    double sum = 0.0;
    double moment = 0.0;
    for (int y = row - 2; y <= row + 2; ++y) {
      const double share = (picture.red(column, y) - carpet) / (paint - carpet);
      sum += share;
      moment += share * (y + 0.5);
    }
    const double width = static_cast<double>(std::abs(near.v - far.v));
    CHECK(width < 0.5);
    share_of_width += sum / width;
    off += moment / sum - static_cast<double>(centre.v);
    places += 1;
  }
  CHECK(share_of_width / places == doctest::Approx(1.0).epsilon(0.1));
  CHECK(std::abs(off / places) < 0.06);
}

TEST_CASE("renderer: black outside the image circle, never inside") {
  Picture picture("fisheye-185", plain_scene(small_field()));
  picture.draw({0.0F, 0.0F, 0.3F}, {0.0F, 0.0F, 0.58F, 0.0F, 0.5F, 0.1F});
  const float radius = picture.lens.max_radius();
  int outside = 0;
  for (int y = 0; y < picture.camera.height; ++y) {
    for (int x = 0; x < picture.camera.width; ++x) {
      const float r = std::hypot(static_cast<float>(x) + 0.5F - picture.camera.lens.cx,
                                 static_cast<float>(y) + 0.5F - picture.camera.lens.cy);
      if (r > radius + 1.0F) {
        outside += 1;
        CHECK(picture.red(x, y) == 0.0);
      }
      if (r < radius - 4.0F) CHECK(picture.red(x, y) > 0.0);
    }
  }
  CHECK(outside > 1000);
}

TEST_CASE("renderer: the same arguments give the same bytes; another noise seed does not") {
  SceneOptions options = random_scene(small_field(), 5);
  std::uint64_t hash[3] = {};
  for (int i = 0; i < 3; ++i) {
    Picture picture("fisheye-140", options);
    const Pose2 robots[1] = {{1.0F, 0.5F, 1.0F}};
    picture.scene.set_moving(robots, 0.3F, {0.5F, 0.5F});
    picture.renderer.render(picture.scene, {-1.0F, 0.2F, 0.1F}, {0.0F, 0.0F, 0.6F, 0.0F, 0.5F, 0.0F}, ImageEffects{},
                            i < 2 ? 7U : 8U, picture.rgb);
    hash[i] = hash_bytes(picture.rgb.data(), picture.rgb.size());
  }
  CHECK(hash[0] == hash[1]);
  CHECK(hash[0] != hash[2]);
}

TEST_CASE("renderer: noise has the strength asked for, blur keeps the mean") {
  Picture picture("fisheye-140", plain_scene(small_field()));
  const CameraPose camera{0.0F, 0.0F, 0.6F, 0.0F, 1.2F, 0.0F};
  const Pose2 robot{1.2F, 0.8F, 0.5F};
  picture.draw(robot, camera);
  const std::vector<std::uint8_t> clean = picture.rgb;
  ImageEffects noisy = no_effects();
  noisy.noise = 5.0F;
  picture.draw(robot, camera, noisy);
  double squares = 0.0;
  int n = 0;
  for (int y = 200; y < 280; ++y) {
    for (int x = 280; x < 360; ++x) {
      const std::size_t i = (static_cast<std::size_t>(y) * 640U + static_cast<std::size_t>(x)) * 3U + 1U;
      const double d = static_cast<double>(picture.rgb[i]) - static_cast<double>(clean[i]);
      squares += d * d;
      n += 1;
    }
  }
  CHECK(std::sqrt(squares / n) == doctest::Approx(5.0).epsilon(0.15));
}

TEST_CASE("renderer: a robot in front hides the line behind it") {
  SceneOptions options = plain_scene(small_field());
  Picture picture("fisheye-185", options);
  const Pose2 robot{-0.5F, 1.0F, 0.0F};
  const CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, 0.5F, 0.0F};
  PixelPoint line;
  REQUIRE(GroundProjection(picture.lens, camera).pixel(to_ground(robot, FieldPoint{0.0F, 1.0F}), line));
  const int x = static_cast<int>(line.u);
  const int y = static_cast<int>(line.v);
  picture.draw(robot, camera);
  const double open = picture.red(x, y);
  const Pose2 other[1] = {{-0.1F, 1.05F, 3.1F}};  // one leg in the way
  picture.scene.set_moving(other, 0.0F, {2.0F, -1.0F});
  CHECK(picture.scene.occluded({-0.5F, 1.0F, 0.58F}, {0.0F, 1.0F, 0.0F}));
  CHECK_FALSE(picture.scene.occluded({-0.5F, 1.0F, 0.58F}, {0.0F, -1.0F, 0.0F}));
  picture.draw(robot, camera);
  CHECK(picture.red(x, y) < 0.5 * open);
}

TEST_CASE("renderer: the other formats carry the same picture") {
  const std::vector<std::uint8_t> rgb = {255, 0, 0, 255, 0, 0, 255, 255, 255, 0, 0, 0};
  std::vector<std::uint8_t> out;
  convert_rgb24(rgb, 4, 1, PixelFormat::bgr24, out);
  CHECK(out[0] == 0);
  CHECK(out[2] == 255);
  convert_rgb24(rgb, 4, 1, PixelFormat::rgb565, out);
  CHECK(out[0] == 0x00);
  CHECK(out[1] == 0xF8);
  CHECK(out[4] == 0xFF);
  convert_rgb24(rgb, 4, 1, PixelFormat::yuyv, out);
  CHECK(out[0] == doctest::Approx(82).epsilon(0.02));  // BT.601 red: Y 82, Cb 90, Cr 240
  CHECK(out[1] == doctest::Approx(90).epsilon(0.02));
  CHECK(out[3] == doctest::Approx(240).epsilon(0.02));
  CHECK(out[4] == 235);
  CHECK(out[6] == 16);
  CHECK(out[5] == 128);
}
