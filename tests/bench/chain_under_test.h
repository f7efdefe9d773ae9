// SPDX-License-Identifier: Apache-2.0
// Pipeline and localizer as a robot would set them up, for the benchmark's tools.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "loc/localizer.h"
#include "tests/bench/bench_frames.h"
#include "tests/bench/kernel_choice.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace touchline::bench {

inline void require(Status status, const char* what) {
  if (status != Status::ok) throw std::runtime_error(std::string(what) + ": " + touchline::to_string(status));
}

template <int W = 320, int H = 240, int Depth = 4>
struct ChainUnderTest {
  PipelineStorage<W, H, Depth> storage;
  Pipeline pipeline{storage.memory()};
  Localizer localizer;
  VisionResult vision;
  KernelChoice kernels;

  explicit ChainUnderTest(const KernelChoice& choice = {}) : kernels(choice) {}

  /// `work_width` x `work_height` up to W x H.
  void configure(const FramePool& pool, int work_width = W, int work_height = H, int particles = 200) {
    VisionConfig config;
    config.frame_width = pool.width;
    config.frame_height = pool.height;
    config.work_width = work_width;
    config.work_height = work_height;
    config.fifo_depth = Depth;
    tell_vision(pool.field, config);
    config.kernels = kernels.vision;
    Lens lens;
    require(Lens::create(pool.lens, lens), "lens");
    require(pipeline.configure(config, lens), "pipeline");
    Field field;
    require(Field::create(pool.field, field), "field");
    LocalizerConfig localizer_config;
    localizer_config.particles = particles;
    localizer_config.kernels = kernels.localization;
    require(localizer.configure(localizer_config, field), "localizer");
    (void)localizer.reset(Prior{}, 1);
  }
  void see(const FrameView& image, const CameraPose& mount, double time_s, StageObserver* observer = nullptr) {
    require(pipeline.process({image, time_s, mount, Pose2{}}, vision, observer), "frame");
  }
  PoseEstimate locate(const View& view, double time_s, StageObserver* observer = nullptr) {
    LocalizerInput input;
    input.time_s = time_s;
    input.has_yaw = view.has_yaw;
    input.yaw = view.yaw;
    PoseEstimate estimate;
    require(localizer.update(input, vision, estimate, observer), "localization");
    return estimate;
  }
  /// A robot that knows about where it stands, as while it tracks its pose.
  void expect_near(const Pose2& pose) {
    const Prior prior = {.kind = PriorKind::pose, .pose = pose, .sigma_xy = 0.05F, .sigma_theta = radians(2.0F)};
    require(localizer.reset(prior, 1), "prior");
  }
};

}  // namespace touchline::bench
