// SPDX-License-Identifier: Apache-2.0
// One call from a camera frame to the features on the ground: the paper's section IV in order.
#pragma once

#include "platform/core/status.h"
#include "vision/camera_movement.h"
#include "vision/green.h"
#include "vision/image/frame.h"
#include "vision/image/frame_fifo.h"
#include "vision/image/subsample.h"
#include "vision/lens/camera_pose.h"
#include "vision/pipeline_memory.h"
#include "vision/stage.h"
#include "vision/vision_config.h"
#include "vision/vision_result.h"

namespace touchline {

/// What a camera's pose may be: in a humanoid robot, or held up for a test; angles of some turns.
inline constexpr float max_camera_reach_m = 10.0F;
inline constexpr float max_camera_angle = 100.0F;  // radians

struct FrameInput {
  FrameView image;
  double time_s = 0.0;
  CameraPose camera;  // at the time of the frame
  Pose2 odometry;     // robot's step since the frame before, robot's frame; only used to see that it moved
};

class Pipeline {
 public:
  /// `memory` outlives the pipeline; it is that of a PipelineStorage<W, H, Depth>.
  explicit Pipeline(const PipelineMemory& memory)
      : memory_(memory), subsampler_(memory.subsample), index_(memory.graph.index) {}

  /// Checks config against the storage; on failure the old configuration stays and `what` names the key ("lens" where
  /// it was never created), when not null.
  Status configure(const VisionConfig& config, const Lens& lens, const char** what = nullptr);
  /// Runs the chain on one frame. wrong_size, invalid_argument (a number that is not finite, a height <= 0, a camera
  /// beyond the limits above), not_ready (not configured): nothing has changed. `result` refers into the storage and is
  /// valid until the next call.
  Status process(const FrameInput& input, VisionResult& result, StageObserver* observer = nullptr);
  /// After a fall or a reset: empties the FIFO.
  void reset();
  [[nodiscard]] const VisionConfig& config() const { return config_; }

 private:
  Status average(const FrameInput& input, VisionResult& result);
  void find_green_stage(VisionResult& result);
  void find_roi(VisionResult& result);
  void find_candidates(VisionResult& result);
  void make_line_mask(VisionResult& result);
  void make_skeleton(VisionResult& result);
  void digest_skeleton(VisionResult& result);
  void build_graph(VisionResult& result);
  void find_features(VisionResult& result);
  void find_post_colour(const VisionResult& result);
  void find_goal_posts(VisionResult& result);
  void make_line_points(VisionResult& result);
  [[nodiscard]] float work_px_per_frame_px() const;
  [[nodiscard]] int scaled(int px) const;
  [[nodiscard]] int scaled_length(int px) const;

  PipelineMemory memory_;
  VisionConfig config_;
  Lens lens_;
  bool configured_ = false;
  PipelineViews views_;
  Subsampler subsampler_;
  FrameFifo fifo_;
  CameraMovement movement_;
  CarpetModel carpet_;
  SkeletonIndex index_;
};

}  // namespace touchline
