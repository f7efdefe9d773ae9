// SPDX-License-Identifier: Apache-2.0
// What a perfect vision would hand to localization from a known pose: the field's lines and junctions projected through
// the lens, with noise on the attitude if wanted. No picture is drawn; for tests of loc alone.
#pragma once

#include <memory>

#include "loc/field.h"
#include "platform/core/rng.h"
#include "tests/support/paper_lens.h"
#include "vision/image/bit_image.h"
#include "vision/vision_result.h"

namespace touchline::test {

struct SyntheticOptions {
  float max_range = 4.0F;    // metres
  float pixel_noise = 0.0F;  // camera pixels, 1 sigma
  float pitch_error = 0.0F;  // radians: true pitch minus the pitch that loc is told
  float roll_error = 0.0F;
  bool junctions = true;
  bool lines = true;
  bool covered = false;  // a hand before the lens: nothing is seen, no carpet either
};

/// Owns what the VisionResult refers to.
class SyntheticView {
 public:
  SyntheticView(const Field& field, const Lens& lens, int frame_width, int frame_height);
  /// The result is valid until the next call.
  const VisionResult& look(const Pose2& truth, const CameraPose& camera, const SyntheticOptions& options, Rng& rng);

 private:
  struct Memory {
    Features features;
    BitImage<320, 240> roi, green, lines;
  };
  void add_line_point(const GroundProjection& told, const GroundPoint& ground, float direction, float length, Rng& rng);
  void draw_line_mask(const Pose2& truth);
  void add_lines(const Pose2& truth, Rng& rng);
  void add_junctions(const Pose2& truth, Rng& rng);
  [[nodiscard]] bool see(const GroundPoint& ground, float noise, Rng& rng, PixelPoint& pixel) const;

  const Field& field_;
  Lens lens_;
  int frame_width_, frame_height_;
  SyntheticOptions options_{};
  GroundProjection true_projection_{}, told_projection_{};
  std::unique_ptr<Memory> memory_;
  VisionResult result_{};
};

}  // namespace touchline::test
