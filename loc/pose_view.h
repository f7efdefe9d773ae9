// SPDX-License-Identifier: Apache-2.0
// A frame as it looks from a pose: where the field's points lie in the picture, with the mount's errors taken out.
#pragma once

#include <algorithm>

#include "platform/core/elementary.h"
#include "platform/core/geometry.h"
#include "vision/image/bit_ops.h"
#include "vision/vision_result.h"

namespace touchline {

class PoseView {
 public:
  /// The errors are radians to add to the frame's pitch and roll. `vision` must outlive the view.
  PoseView(const VisionResult& vision, const Pose2& pose, float pitch_error, float roll_error)
      : vision_(vision),
        projection_(vision.projection.lens(), corrected(vision.projection.pose(), pitch_error, roll_error)),
        pose_(pose),
        turn_(math::sin_cos(pose.theta)),
        scale_u_(static_cast<float>(vision.work_width) / static_cast<float>(vision.frame_width)),
        scale_v_(static_cast<float>(vision.work_height) / static_cast<float>(vision.frame_height)) {}

  [[nodiscard]] const GroundProjection& projection() const { return projection_; }
  /// to_ground(), with the sine and the cosine taken once.
  [[nodiscard]] GroundPoint ground(const FieldPoint& p) const {
    const float dx = p.x - pose_.x;
    const float dy = p.y - pose_.y;
    return {turn_.cos * dx + turn_.sin * dy, turn_.cos * dy - turn_.sin * dx};
  }
  /// False when the point lies outside the picture or beyond the lens.
  [[nodiscard]] bool camera_pixel(const GroundPoint& g, PixelPoint& p) const {
    return projection_.pixel(g, p) && in_picture(p);
  }
  [[nodiscard]] bool working_pixel(const GroundPoint& g, int& x, int& y) const {
    PixelPoint p;
    return projection_.pixel(g, p) && working_pixel(p, x, y);
  }
  /// Of a camera pixel; false outside the picture.
  [[nodiscard]] bool working_pixel(const PixelPoint& p, int& x, int& y) const {
    if (!in_picture(p)) return false;
    x = static_cast<int>(p.u * scale_u_);
    y = static_cast<int>(p.v * scale_v_);
    return x < vision_.work_width && y < vision_.work_height;
  }
  /// Whether the line mask has a pixel within `reach` of (x, y), which lies in the picture; rows and columns each.
  [[nodiscard]] bool line_near(int x, int y, int reach) const {
    return any_set(vision_.line_mask, std::max(x - reach, 0), std::max(y - reach, 0),
                   std::min(x + reach, vision_.work_width - 1), std::min(y + reach, vision_.work_height - 1));
  }

 private:
  [[nodiscard]] bool in_picture(const PixelPoint& p) const {
    return p.u >= 0.0F && p.v >= 0.0F && p.u < static_cast<float>(vision_.frame_width) &&
           p.v < static_cast<float>(vision_.frame_height);
  }
  static CameraPose corrected(CameraPose camera, float pitch_error, float roll_error) {
    camera.pitch += pitch_error;
    camera.roll += roll_error;
    return camera;
  }

  const VisionResult& vision_;
  GroundProjection projection_;
  Pose2 pose_;
  math::SinCos turn_;
  float scale_u_, scale_v_;  // camera pixels to working pixels
};

}  // namespace touchline
