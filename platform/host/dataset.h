// SPDX-License-Identifier: Apache-2.0
// A data set in memory: a folder with dataset.toml, frames.jsonl and images. Images are read one by one, later.
// Everything is checked while reading: what this returns can be handed to vision and localization as it is.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loc/field.h"
#include "platform/core/geometry.h"
#include "vision/lens/camera_pose.h"
#include "vision/lens/lens.h"

namespace touchline::host {

enum class Protocol {
  independent,  // each frame is a start from nothing
  sequence,     // one run through all frames
};
const char* to_string(Protocol protocol);

/// Camera and mount of a frame: the data set's, with the keys that the frame overrides.
struct CameraSetup {
  int width = 0;  // camera pixels
  int height = 0;
  LensParameters lens;
  CameraPose mount;
};

struct DataFrame {
  std::string image;           // as written in the file, e.g. "images/000.png"
  std::filesystem::path path;  // of the image
  int line = 0;                // of frames.jsonl
  bool has_time = false;
  double time_s = 0.0;
  CameraSetup camera;
  bool has_odometry = false;
  Pose2 odometry;  // robot's step since the frame before, as the gait believes it
  bool has_yaw = false;
  float yaw = 0.0F;  // IMU yaw minus the stored goal yaw, radians in (-pi, pi]
  bool has_truth = false;
  Pose2 truth;
  bool kidnap = false;  // the robot was picked up before this frame; for the judge only, never for the localizer
};

struct DataSet {
  std::filesystem::path folder;
  std::string name;
  Protocol protocol = Protocol::independent;
  std::string field_name;  // the preset's, or "free"
  FieldDimensions field;
  CameraSetup camera;  // the mount's height is 0 where the frames alone give it
  double goal_yaw_deg = 0.0;
  std::vector<DataFrame> frames;
  std::vector<std::string> warnings;  // sentences about keys that nobody uses
};

/// Reads the whole folder but the images. Throws HostError.
DataSet read_dataset(const std::filesystem::path& folder);
/// Reads a dataset.toml alone (for single images): no frames.
DataSet read_dataset_toml(const std::filesystem::path& file);
/// The image of a frame; throws FrameError when it is missing, damaged or of another size than the camera's.
struct RgbImage read_frame_image(const DataFrame& frame);

}  // namespace touchline::host
