// SPDX-License-Identifier: Apache-2.0
// What vision found and where localization stands, drawn over the camera's picture: the team's debugging tool.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "loc/known_junctions.h"
#include "loc/localizer.h"
#include "platform/host/canvas.h"
#include "platform/host/image_file.h"
#include "vision/vision_result.h"

namespace touchline::host {

/// A working pixel in the camera's picture.
struct WorkToCamera {
  float x = 1.0F;
  float y = 1.0F;
  WorkToCamera(const VisionResult& vision, int camera_width, int camera_height)
      : x(static_cast<float>(camera_width) / static_cast<float>(vision.work_width)),
        y(static_cast<float>(camera_height) / static_cast<float>(vision.work_height)) {}
  [[nodiscard]] DrawPoint operator()(GridPoint p) const {
    return {(static_cast<float>(p.x) + 0.5F) * x, (static_cast<float>(p.y) + 0.5F) * y};
  }
};

Colour colour_of(JunctionType type);

/// The field's lines and circle as the camera would see them from `pose`.
void draw_projected_field(Canvas& canvas, const GroundProjection& projection, const Field& field, const Pose2& pose,
                          Colour colour);
/// Junctions with type and branches, rejected candidates with the reason's short code, posts, circle.
void draw_features(Canvas& canvas, const GroundProjection& projection, const Features& features, bool rejected);
/// The set pixels of a mask, in camera pixels.
void draw_mask(Canvas& canvas, const ConstBitView& mask, const WorkToCamera& to_camera, Colour colour, float share);

struct OverlayInput {
  const RgbImage* picture = nullptr;
  const VisionResult* vision = nullptr;
  const Field* field = nullptr;
  PoseEstimate estimate;
  std::vector<KnownJunction> known;
  bool has_truth = false;
  Pose2 truth;
  std::vector<Pose2> particles;
  std::vector<std::string> text;  // lines for the panel at the side
};
/// The annotated picture of one frame, with a panel at its right: map, text and legend.
RgbImage draw_overlay(const OverlayInput& input);

}  // namespace touchline::host
