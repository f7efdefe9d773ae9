// SPDX-License-Identifier: Apache-2.0
// One call from a camera frame to the features on the ground: the paper's section IV in order.
#pragma once

#include "platform/core/status.h"
#include "vision/image/frame.h"
#include "vision/lens/camera_pose.h"
#include "vision/stage.h"
#include "vision/vision_config.h"
#include "vision/vision_result.h"

namespace touchline {

struct FrameInput {
  FrameView image;
  double time_s = 0.0;
  CameraPose camera;  // at the time of the frame
  Pose2 odometry;     // robot's step since the frame before, robot's frame; only used to see that it moved
};

/// Views of all memory that the chain works in; made by PipelineStorage<W, H, Depth>. (Members: see pipeline.cpp's
/// needs.)
struct PipelineMemory;

class Pipeline {
 public:
  explicit Pipeline(PipelineMemory& memory);
  /// Checks config against the storage; on failure the old configuration stays and `what` names the key, when not null.
  Status configure(const VisionConfig& config, const Lens& lens, const char** what = nullptr);
  /// Runs the chain on one frame. wrong_size, invalid_argument (NaN, height <= 0), not_ready (not configured):
  /// nothing has changed. `result` refers into the storage and is valid until the next call.
  Status process(const FrameInput& input, VisionResult& result, StageObserver* observer = nullptr);
  /// After a fall or a reset: empties the FIFO.
  void reset();

 private:
  PipelineMemory& memory_;
};

}  // namespace touchline
