// SPDX-License-Identifier: Apache-2.0
// Every number of the vision chain's configuration and of a frame's camera, set to what no number may be.
#include "vision/vision_config.h"

#include <doctest/doctest.h>

#include <limits>
#include <memory>
#include <string_view>

#include "tests/vision/painted_field.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

using namespace touchline;
using namespace touchline::test;

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float never[] = {nan, infinite, -infinite, 1e30F, -1e30F};

template <typename Number>
struct Key {
  std::string_view name;
  Number& (*of)(VisionConfig& config);
};
using C = VisionConfig;
constexpr Key<float> lengths[] = {
    {"line_width_m", [](C& c) -> float& { return c.line_width_m; }},
    {"circle_radius_m", [](C& c) -> float& { return c.circle_radius_m; }},
    {"post_diameter_m", [](C& c) -> float& { return c.post_diameter_m; }},
    {"max_range_m", [](C& c) -> float& { return c.max_range_m; }},
    {"body_mask", [](C& c) -> float& { return c.body_mask[0][1].u; }},
    {"body_mask", [](C& c) -> float& { return c.body_mask[0][2].v; }},
};
constexpr Key<int> counts[] = {
    {"frame_width", [](C& c) -> int& { return c.frame_width; }},
    {"frame_width", [](C& c) -> int& { return c.frame_height; }},
    {"work_width", [](C& c) -> int& { return c.work_width; }},
    {"work_width", [](C& c) -> int& { return c.work_height; }},
    {"fifo_depth", [](C& c) -> int& { return c.fifo_depth; }},
    {"green_erode_px", [](C& c) -> int& { return c.green_erode_px; }},
    {"green_dilate_px", [](C& c) -> int& { return c.green_dilate_px; }},
    {"line_dilate_px", [](C& c) -> int& { return c.line_dilate_px; }},
    {"line_erode_px", [](C& c) -> int& { return c.line_erode_px; }},
    {"digestion_radius_px", [](C& c) -> int& { return c.digestion_radius_px; }},
    {"low_weight", [](C& c) -> int& { return c.low_weight; }},
    {"medium_weight", [](C& c) -> int& { return c.medium_weight; }},
    {"high_weight", [](C& c) -> int& { return c.high_weight; }},
    {"spur_px", [](C& c) -> int& { return c.spur_px; }},
};

VisionConfig masked() {
  VisionConfig config;
  MaskPolygon foot;
  for (const PixelPoint& p : {PixelPoint{300.0F, 400.0F}, PixelPoint{-50.0F, 600.0F}, PixelPoint{450.0F, 600.0F}}) {
    foot.push_back(p);
  }
  config.body_mask.push_back(foot);
  return config;
}

struct Chain {
  std::unique_ptr<PipelineStorage<320, 240, 4>> storage = std::make_unique<PipelineStorage<320, 240, 4>>();
  Pipeline pipeline{storage->memory()};
  VisionResult result;

  std::string_view refused(const VisionConfig& config) {
    const char* what = "";
    CHECK(pipeline.configure(config, paper_lens(), &what) != Status::ok);
    return what;
  }
};

}  // namespace

TEST_CASE("every number of the configuration is checked, and the refused key is named") {
  Chain chain;
  REQUIRE(chain.pipeline.configure(masked(), paper_lens()) == Status::ok);
  for (const auto& key : lengths) {
    for (const float value : never) {
      CAPTURE(key.name);
      CAPTURE(value);
      VisionConfig config = masked();
      key.of(config) = value;
      CHECK(chain.refused(config) == key.name);
    }
  }
  for (const auto& key : counts) {
    for (const int value : {-1, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
      CAPTURE(key.name);
      CAPTURE(value);
      VisionConfig config = masked();
      key.of(config) = value;
      CHECK(chain.refused(config) == key.name);
    }
  }
}

TEST_CASE("a range of colours has hues up to 179, and its bounds in order") {
  Chain chain;
  VisionConfig config;
  config.green.hue_high = 180;
  CHECK(chain.refused(config) == "green");
  config = {};
  config.yellow_post.saturation_low = 200;
  config.yellow_post.saturation_high = 100;
  CHECK(chain.refused(config) == "yellow_post");
  config = {};
  config.white_post.value_low = 200;
  config.white_post.value_high = 100;
  CHECK(chain.refused(config) == "white_post");
  config = {};
  void (*const take_away[])(Kernels&) = {
      [](Kernels& k) { k.find_ridges = nullptr; },       [](Kernels& k) { k.hsv_rows = nullptr; },
      [](Kernels& k) { k.white_rows = nullptr; },        [](Kernels& k) { k.change_rows = nullptr; },
      [](Kernels& k) { k.subsample.halve = nullptr; },   [](Kernels& k) { k.subsample.reduce_columns = nullptr; },
      [](Kernels& k) { k.carpet.sum_chroma = nullptr; }, [](Kernels& k) { k.probes.places = nullptr; },
  };
  for (const auto& take : take_away) {
    config.kernels = portable_kernels();
    take(config.kernels);
    CHECK(chain.refused(config) == "kernels");
  }
}

TEST_CASE("every number of a frame's camera is checked") {
  Chain chain;
  REQUIRE(chain.pipeline.configure({}, paper_lens()) == Status::ok);
  const Picture picture = paint(Scene{}, GroundProjection(paper_lens(), usual_pose()));
  using P = CameraPose;
  float& (*const numbers[])(P&) = {[](P& p) -> float& { return p.x; },      [](P& p) -> float& { return p.y; },
                                   [](P& p) -> float& { return p.height; }, [](P& p) -> float& { return p.yaw; },
                                   [](P& p) -> float& { return p.pitch; },  [](P& p) -> float& { return p.roll; }};
  for (const auto& number : numbers) {
    for (const float value : never) {
      CameraPose pose = usual_pose();
      number(pose) = value;
      CHECK(chain.pipeline.process({picture.view(), 0.0, pose, {}}, chain.result) == Status::invalid_argument);
    }
  }
  CHECK(chain.pipeline.process({picture.view(), 0.0, usual_pose(), {}}, chain.result) == Status::ok);
}
