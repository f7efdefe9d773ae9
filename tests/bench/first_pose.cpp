// SPDX-License-Identifier: Apache-2.0
// From the start of a process to the pose of one raw frame: what a robot waits after power-up.
//   first_pose RAW    752x480 RGB24 of the simulator's camera, 1,082,880 bytes
#include <cstdio>

#include "loc/localizer.h"
#include "platform/processor/fastest_kernels.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace {
touchline::PipelineStorage<> storage;
touchline::Localizer localizer;
std::uint8_t pixels[752 * 480 * 3];
}  // namespace

int main(int argc, char** argv) {
  using namespace touchline;
  std::FILE* file = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr || std::fread(pixels, 1, sizeof pixels, file) != sizeof pixels) {
    std::fputs("usage: first_pose RAW (752x480 RGB24)\n", stderr);
    return 2;
  }
  std::fclose(file);
  Lens lens;
  Field field;
  Pipeline pipeline(storage.memory());
  VisionConfig vision;
  vision.kernels = fastest_kernels();
  LocalizerConfig localization;
  localization.kernels = fastest_loc_kernels();
  const LensParameters fisheye{.focal_px = 232.9F, .cx = 376.0F, .cy = 240.0F, .max_theta = radians(92.5F)};
  if (Lens::create(fisheye, lens) != Status::ok || Field::create(*field_preset("small-2026"), field) != Status::ok ||
      pipeline.configure(vision, lens) != Status::ok || localizer.configure(localization, field) != Status::ok) {
    return 1;
  }
  (void)localizer.reset(Prior{}, 1);
  VisionResult seen;
  PoseEstimate estimate;
  const CameraPose camera{.height = 0.58F, .pitch = radians(30.0F)};
  Status status = pipeline.process({{PixelFormat::rgb24, pixels, 752, 480, 752 * 3}, 0.0, camera, Pose2{}}, seen);
  if (status == Status::ok) status = localizer.update(LocalizerInput{}, seen, estimate);
  std::printf("%s %.3f %.3f\n", to_string(status), static_cast<double>(estimate.pose.x),
              static_cast<double>(estimate.pose.y));
  return status == Status::ok && estimate.valid ? 0 : 1;
}
