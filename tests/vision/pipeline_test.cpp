// SPDX-License-Identifier: Apache-2.0
// The chain as its caller sees it: what it refuses, what it leaves out, and that a painted field comes out as lines.
#include "vision/pipeline.h"

#include <doctest/doctest.h>

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "tests/vision/painted_field.h"
#include "vision/image/bit_ops.h"
#include "vision/pipeline_storage.h"

using namespace touchline;
using namespace touchline::test;

namespace {

struct Chain {
  std::unique_ptr<PipelineStorage<320, 240, 4>> storage = std::make_unique<PipelineStorage<320, 240, 4>>();
  Pipeline pipeline{storage->memory()};
  VisionConfig config;
  VisionResult result;

  Chain() {
    config.line_width_m = 0.10F;
    REQUIRE(pipeline.configure(config, test::paper_lens()) == Status::ok);
  }
  Status run(const Picture& picture, const CameraPose& pose = usual_pose(), const Pose2& step = {}) {
    return pipeline.process({picture.view(), 0.0, pose, step}, result);
  }
};

Scene cross() {
  Scene scene;
  scene.noise = 5.0F;
  scene.carpet_radius = 3.5F;
  scene.stripes = {{{1.2F, -2.5F}, {1.2F, 2.5F}, 0.10F, line_white}, {{0.2F, 0.4F}, {2.8F, 0.4F}, 0.10F, line_white}};
  return scene;
}

Picture painted(const Scene& scene, const CameraPose& pose = usual_pose()) {
  return paint(scene, GroundProjection(test::paper_lens(), pose));
}

/// Distance to the nearer of the two lines of cross().
float off_line(const LinePoint& p) { return math::min(math::abs(p.ground.x - 1.2F), math::abs(p.ground.y - 0.4F)); }

}  // namespace

TEST_CASE("line points of a painted cross lie on it, and cover it") {
  Chain chain;
  REQUIRE(chain.run(painted(cross())) == Status::ok);
  const auto points = chain.result.features->line_points.span();
  REQUIRE(points.size() > 100);
  int off = 0;
  bool left = false, right = false, near = false, far = false;
  for (const LinePoint& p : points) {
    off += off_line(p) > math::max(0.5F * p.sigma, 0.01F) ? 1 : 0;
    left = left || p.ground.y > 1.5F;
    right = right || p.ground.y < -1.5F;
    near = near || p.ground.x < 0.4F;
    far = far || p.ground.x > 2.4F;
  }
  CHECK(off * 50 < static_cast<int>(points.size()));
  CHECK(left);
  CHECK(right);
  CHECK(near);
  CHECK(far);
}

TEST_CASE("a dim picture and a shadow give the same lines") {
  for (const float light : {1.0F, 0.35F}) {
    Scene scene = cross();
    scene.light = {light, light, light};
    scene.noise *= light;
    scene.shadow_from_y = -0.3F;
    Chain chain;
    REQUIRE(chain.run(painted(scene)) == Status::ok);
    CHECK(chain.result.features->line_points.size() > 100);
    for (const LinePoint& p : chain.result.features->line_points.span())
      CHECK(off_line(p) < math::max(p.sigma, 0.015F));
  }
}

TEST_CASE("the products are there, and belong together") {
  Chain chain;
  REQUIRE(chain.run(painted(cross())) == Status::ok);
  const VisionResult& r = chain.result;
  CHECK(r.work_width == 320);
  CHECK(r.mean.y.height == 240);
  CHECK(r.counts.frames_in_mean == 1);
  CHECK(r.hull.size() >= 3);
  CHECK(r.hull.size() >= 3);
  CHECK(r.counts.skeleton_pixels > 200);
  const int skeleton = count(r.skeleton);
  CHECK(skeleton == r.counts.skeleton_pixels);
  for_each_set_bit(r.skeleton, [&](int x, int y) {
    CHECK(r.line_mask.get(x, y));
    CHECK(r.roi.get(x, y));
  });
}

TEST_CASE("nothing to see is a valid empty result") {
  Chain chain;
  const Picture black{752, 480, std::vector<std::uint8_t>(752 * 480 * 3)};
  REQUIRE(chain.run(black) == Status::ok);
  CHECK(chain.result.features->line_points.empty());
  CHECK(chain.result.counts.skeleton_pixels == 0);
  CHECK(chain.result.hull.empty());
}

TEST_CASE("what it refuses, and that nothing changes then") {
  Chain chain;
  const Picture good = painted(cross());
  REQUIRE(chain.run(good) == Status::ok);
  const std::size_t before = chain.result.features->line_points.size();
  CameraPose pose = usual_pose();
  Picture small = good;
  small.height = 400;
  CHECK(chain.run(small) == Status::wrong_size);
  pose.height = 0.0F;
  CHECK(chain.run(good, pose) == Status::invalid_argument);
  pose = usual_pose();
  pose.pitch = std::numeric_limits<float>::quiet_NaN();
  CHECK(chain.run(good, pose) == Status::invalid_argument);
  CHECK(chain.run(good, usual_pose(), {0, std::numeric_limits<float>::infinity(), 0}) == Status::invalid_argument);
  CHECK(chain.result.features->line_points.size() == before);

  const auto storage = std::make_unique<PipelineStorage<320, 240, 1>>();
  Pipeline fresh(storage->memory());
  VisionResult result;
  CHECK(fresh.process({good.view(), 0.0, usual_pose(), {}}, result) == Status::not_ready);
}

TEST_CASE("a configuration that cannot be is refused by name, and the old one stays") {
  Chain chain;
  const auto refused = [&](auto change) {
    VisionConfig config = chain.config;
    change(config);
    const char* what = nullptr;
    CHECK(chain.pipeline.configure(config, test::paper_lens(), &what) != Status::ok);
    REQUIRE(what != nullptr);
    return std::string(what);
  };
  const char* what = nullptr;
  CHECK(chain.pipeline.configure(chain.config, Lens{}, &what) == Status::invalid_argument);
  CHECK(std::string(what) == "lens");
  CHECK(refused([](VisionConfig& c) { c.fifo_depth = 5; }) == "fifo_depth");  // the storage holds four
  CHECK(refused([](VisionConfig& c) { c.work_width = 640; }) == "work_width");
  CHECK(refused([](VisionConfig& c) { c.green_erode_px = 2; }) == "green_erode_px");
  CHECK(refused([](VisionConfig& c) { c.line_width_m = 0.0F; }) == "line_width_m");
  CHECK(refused([](VisionConfig& c) { c.frame_width = 100; }) == "frame_width");
  CHECK(chain.run(painted(cross())) == Status::ok);
}

TEST_CASE("frames that moved are left out of the mean") {
  Chain chain;
  const Picture picture = painted(cross());
  REQUIRE(chain.run(picture) == Status::ok);
  REQUIRE(chain.run(picture) == Status::ok);
  CHECK(chain.result.counts.frames_in_mean == 2);
  SUBCASE("the head turned down by a degree: two working pixels") {
    CameraPose pose = usual_pose();
    pose.pitch += radians(1.0F);
    REQUIRE(chain.run(picture, pose) == Status::ok);
    CHECK(chain.result.counts.frames_in_mean == 1);
    CHECK(chain.result.counts.frames_left_out == 2);
  }
  SUBCASE("the robot stepped by 2 cm") {
    REQUIRE(chain.run(picture, usual_pose(), {0.02F, 0, 0}) == Status::ok);
    CHECK(chain.result.counts.frames_in_mean == 1);
    REQUIRE(chain.run(picture) == Status::ok);  // and then stood
    CHECK(chain.result.counts.frames_in_mean == 2);
    CHECK(chain.result.counts.frames_left_out == 2);
  }
  SUBCASE("it trembled by a tenth of a degree") {
    CameraPose pose = usual_pose();
    pose.roll += radians(0.1F);
    REQUIRE(chain.run(picture, pose) == Status::ok);
    CHECK(chain.result.counts.frames_in_mean == 3);
  }
  SUBCASE("it fell") {
    chain.pipeline.reset();
    REQUIRE(chain.run(picture) == Status::ok);
    CHECK(chain.result.counts.frames_in_mean == 1);
    CHECK(chain.result.counts.frames_left_out == 0);
  }
}

TEST_CASE("twice the working size gives the same lines") {
  const auto storage = std::make_unique<PipelineStorage<640, 480, 1>>();
  Pipeline pipeline(storage->memory());
  VisionConfig config;
  config.line_width_m = 0.10F;
  config.fifo_depth = 1;
  config.work_width = 640;
  config.work_height = 480;
  REQUIRE(pipeline.configure(config, test::paper_lens()) == Status::ok);
  const Picture picture = painted(cross());
  VisionResult result;
  REQUIRE(pipeline.process({picture.view(), 0.0, usual_pose(), {}}, result) == Status::ok);
  CHECK(result.work_width == 640);
  REQUIRE(result.features->line_points.size() > 200);
  int off = 0;
  for (const LinePoint& p : result.features->line_points.span()) off += off_line(p) > math::max(p.sigma, 0.01F) ? 1 : 0;
  CHECK(off * 50 < static_cast<int>(result.features->line_points.size()));
}

TEST_CASE("what finds no room is counted where it was lost, and the frame stays valid") {
  Scene scene = cross();
  scene.carpet_radius = 2.0F;
  scene.stripes.push_back({{3.2F, -1.0F}, {3.2F, 1.0F}, 1.2F, carpet_green});  // another blob, beyond a ring of floor
  const Picture picture = painted(scene);
  struct Shrunk {
    const char* what;
    void (*shrink)(PipelineMemory&);
    int VisionCounts::*counter;
  };
  const Shrunk cases[] = {
      {"blobs", [](PipelineMemory& m) { m.blobs = m.blobs.first(1); }, &VisionCounts::dropped_blobs},
      {"pixels", [](PipelineMemory& m) { m.graph.index.pixels = m.graph.index.pixels.first(40); },
       &VisionCounts::dropped_points},
      {"major nodes", [](PipelineMemory& m) { m.graph.digestion.major_nodes = m.graph.digestion.major_nodes.first(5); },
       &VisionCounts::dropped_nodes},
      {"graph nodes", [](PipelineMemory& m) { m.graph.graph.nodes = m.graph.graph.nodes.first(5); },
       &VisionCounts::dropped_nodes},
      {"edges", [](PipelineMemory& m) { m.graph.graph.edges = m.graph.graph.edges.first(5); },
       &VisionCounts::dropped_edges},
  };
  for (const Shrunk& c : cases) {
    const std::string what = c.what;
    CAPTURE(what);
    const auto storage = std::make_unique<PipelineStorage<320, 240, 4>>();
    PipelineMemory memory = storage->memory();
    c.shrink(memory);
    Pipeline pipeline(memory);
    VisionConfig config;
    config.line_width_m = 0.10F;
    REQUIRE(pipeline.configure(config, test::paper_lens()) == Status::ok);
    VisionResult result;
    REQUIRE(pipeline.process({picture.view(), 0.0, usual_pose(), {}}, result) == Status::ok);
    CHECK(result.counts.*c.counter > 0);
    CHECK(result.counts.dropped() >= result.counts.*c.counter);
    CHECK(result.features->line_points.size() > 20);
  }
}

TEST_CASE("all that was dropped is the sum of every counter of it") {
  VisionCounts counts;
  counts.dropped_blobs = 1;
  counts.dropped_edge_seeds = 2;
  counts.dropped_nodes = 4;
  counts.dropped_edges = 8;
  counts.dropped_points = 16;
  counts.dropped_junctions = 32;
  counts.dropped_posts = 64;
  counts.dropped_line_points = 128;
  CHECK(counts.dropped() == 255);
}
