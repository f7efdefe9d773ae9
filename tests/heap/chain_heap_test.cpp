// SPDX-License-Identifier: Apache-2.0
// The whole chain, frame to pose, takes nothing from the heap once it stands: 1,000 frames of a walk, counted.
#include <doctest/doctest.h>

#include <array>
#include <memory>
#include <vector>

#include "loc/localizer.h"
#include "tests/support/drawn_field.h"
#include "tests/support/heap_guard.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace {

using namespace touchline;

constexpr int width = 752;
constexpr int height = 480;
constexpr int pictures = 8;  // drawn beforehand, then shown in turn, there and back

/// A robot on the paper's field with a 185 degree lens, the pictures of a short walk, and the chain.
struct Robot {
  Field field;
  Lens lens;
  CameraPose camera{.height = 0.58F, .pitch = radians(32.0F), .roll = radians(1.0F)};
  std::array<Pose2, pictures> path;
  std::array<std::vector<std::uint8_t>, pictures> images;
  std::unique_ptr<PipelineStorage<>> storage = std::make_unique<PipelineStorage<>>();
  Pipeline pipeline{storage->memory()};
  std::unique_ptr<Localizer> localizer = std::make_unique<Localizer>();

  explicit Robot(LocModel model) {
    REQUIRE(Field::create(*field_preset("acyut-5x3"), field) == Status::ok);
    LensParameters parameters;
    parameters.focal_px = 232.9F;
    parameters.cx = 376.0F;
    parameters.cy = 240.0F;
    parameters.max_theta = radians(92.5F);
    REQUIRE(Lens::create(parameters, lens) == Status::ok);
    const GroundProjection projection(lens, camera);
    for (std::size_t i = 0; i < pictures; ++i) {
      path[i] = {-1.2F + 0.05F * static_cast<float>(i), 0.4F, radians(10.0F * static_cast<float>(i))};
      images[i].resize(static_cast<std::size_t>(width) * height * 3);
      test::draw_field(field, projection, path[i], width, height, images[i]);
    }
    VisionConfig vision;
    tell_vision(field.dimensions(), vision);
    REQUIRE(pipeline.configure(vision, lens) == Status::ok);
    LocalizerConfig loc;
    loc.model = model;
    loc.landmarks = Landmarks::both;
    REQUIRE(localizer->configure(loc, field) == Status::ok);
    (void)localizer->reset({}, 1);
  }
};

struct Outcome {
  std::uint64_t allocations = 0;
  int failures = 0;
  int frames_with_lines = 0;
  int poses = 0;
};

Outcome walk(Robot& robot, int frames) {
  Outcome outcome;
  VisionResult vision;
  PoseEstimate estimate;
  std::size_t last = 0;
  const test::HeapGuard guard;
  for (int i = 0; i < frames; ++i) {
    const int round = i % (2 * pictures - 2);
    const auto now = static_cast<std::size_t>(round < pictures ? round : 2 * pictures - 2 - round);
    const Pose2 step = compose(inverse(robot.path[last]), robot.path[now]);
    last = now;
    const double time_s = i / 12.0;
    if (i % 250 == 249) {  // a fall
      robot.pipeline.reset();
      (void)robot.localizer->reset({}, static_cast<std::uint64_t>(i));
    }
    const FrameView image{PixelFormat::rgb24, robot.images[now].data(), width, height, width * 3};
    if (robot.pipeline.process({image, time_s, robot.camera, step}, vision) != Status::ok) ++outcome.failures;
    const LocalizerInput input{.time_s = time_s, .odometry = step, .has_yaw = true, .yaw = robot.path[now].theta};
    if (robot.localizer->update(input, vision, estimate) != Status::ok) ++outcome.failures;
    if (!vision.features->line_points.empty()) ++outcome.frames_with_lines;
    if (estimate.valid) ++outcome.poses;
  }
  outcome.allocations = guard.allocations();
  return outcome;
}

void check(LocModel model, int frames) {
  Robot robot(model);
  const Outcome outcome = walk(robot, frames);
  CHECK(outcome.allocations == 0);
  CHECK(outcome.failures == 0);
  // The chain had work to do.
  CHECK(outcome.frames_with_lines == frames);
  CHECK(outcome.poses > frames / 2);
}

}  // namespace

TEST_CASE("1,000 frames from pixels to pose allocate nothing, full model") { check(LocModel::full, 1000); }
TEST_CASE("1,000 frames from pixels to pose allocate nothing, paper model") { check(LocModel::paper, 1000); }
