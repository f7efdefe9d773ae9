// SPDX-License-Identifier: Apache-2.0
// A user's first program: one grey frame goes from the camera to the localizer. Built against an install by the tests.
#include <touchline.h>

#include <cstdio>

static touchline::PipelineStorage<> storage;  // all memory of the vision chain
static touchline::Localizer localizer;        // all memory of localization
static std::uint8_t pixels[752 * 480 * 3];    // the camera's frame

int main() {
  using namespace touchline;
  Lens lens;
  Field field;
  Pipeline pipeline(storage.memory());
  VisionConfig vision;
  LocalizerConfig localization;
  vision.kernels = fastest_kernels();  // the widest vectors that this processor has
  localization.kernels = fastest_loc_kernels();
  const LensParameters fisheye{.focal_px = 232.9F, .cx = 376.0F, .cy = 240.0F, .max_theta = radians(92.5F)};
  if (Lens::create(fisheye, lens) != Status::ok || Field::create(*field_preset("small-2026"), field) != Status::ok ||
      pipeline.configure(vision, lens) != Status::ok || localizer.configure(localization, field) != Status::ok ||
      localizer.reset(Prior{}, 1) != Status::ok) {
    return 1;
  }

  VisionResult seen;
  PoseEstimate estimate;
  const FrameView frame{PixelFormat::rgb24, pixels, 752, 480, 752 * 3};
  const CameraPose camera{.height = 0.58F, .pitch = radians(30.0F)};
  Status status = pipeline.process({frame, 0.0, camera, Pose2{}}, seen);
  if (status == Status::ok) status = localizer.update(LocalizerInput{}, seen, estimate);
  std::printf("%s, %d line pixels, %s\n", to_string(status), seen.counts.line_pixels,
              estimate.valid ? "a pose" : "no pose yet");
}
