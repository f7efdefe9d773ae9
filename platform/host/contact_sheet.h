// SPDX-License-Identifier: Apache-2.0
// Every stage of the chain on one sheet, laid out like the paper's figures 1A-C, 2A-C and 3A-B.
#pragma once

#include <span>

#include "loc/localizer.h"
#include "platform/host/image_file.h"
#include "vision/vision_result.h"

namespace touchline::host {

struct ContactSheetInput {
  const RgbImage* picture = nullptr;  // the camera frame
  const VisionResult* vision = nullptr;
  const Field* field = nullptr;
  PoseEstimate estimate;
  std::span<const Pose2> particles;
};
RgbImage draw_contact_sheet(const ContactSheetInput& input);

}  // namespace touchline::host
