// SPDX-License-Identifier: Apache-2.0
// Pipeline and localizer with their memory on the heap, for the host's tools: sizes chosen at run time, errors thrown.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "loc/localizer.h"
#include "platform/core/frame.h"
#include "platform/host/dataset.h"
#include "vision/stage.h"
#include "vision/vision_result.h"

namespace touchline::host {

struct ChainOptions {
  LocModel model = LocModel::full;
  Landmarks landmarks = Landmarks::lines;
  int work_width = 320;  // 320x240 or 640x480
  int work_height = 240;
  int particles = 200;
};

class Chain {
 public:
  /// Throws HostError for a working size that is not offered, or a field or configuration that is refused.
  Chain(const ChainOptions& options, const FieldDimensions& field);
  ~Chain();
  Chain(const Chain&) = delete;
  Chain& operator=(const Chain&) = delete;

  /// A start from nothing: empties the FIFO, draws the particles anew.
  void forget(std::uint64_t seed);
  /// Both throw FrameError for a frame that is refused.
  /// Vision on one frame; the result is valid until the next call.
  const VisionResult& see(const FrameView& image, double time_s, const CameraSetup& camera, const Pose2& odometry,
                          StageObserver* observer);
  /// Localization on what was seen last.
  PoseEstimate locate(const LocalizerInput& input, StageObserver* observer);

  [[nodiscard]] const VisionResult& vision() const;
  [[nodiscard]] const Field& field() const;
  [[nodiscard]] std::vector<Pose2> particles();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace touchline::host
