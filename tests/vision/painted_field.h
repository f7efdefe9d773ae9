// SPDX-License-Identifier: Apache-2.0
// Small pictures of a carpet with lines, painted through a lens by asking each camera pixel which ground it sees.
// Seeded noise. Test support: heap is fine here.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/core/geometry.h"
#include "tests/support/paper_lens.h"
#include "vision/image/frame.h"
#include "vision/image/image_view.h"
#include "vision/lens/camera_pose.h"

namespace touchline::test {

struct Rgb {
  float r = 0, g = 0, b = 0;
};
inline constexpr Rgb carpet_green{40, 120, 60};
inline constexpr Rgb line_white{215, 215, 215};
inline constexpr Rgb wall_grey{150, 150, 150};

/// A stripe on the ground, in the robot's frame.
struct Stripe {
  GroundPoint a, b;
  float width = 0.10F;
  Rgb colour = line_white;
};

struct Scene {
  std::vector<Stripe> stripes;
  float carpet_radius = 100.0F;  // of the carpet around the robot, metres; beyond it lies grey floor
  Rgb carpet = carpet_green;
  Rgb floor = wall_grey;
  Rgb light{1, 1, 1};            // multiplies everything
  float shadow_from_y = 100.0F;  // ground left of this lies in a shadow
  float shadow = 0.45F;
  float noise = 0.0F;  // standard deviation of each channel, grey levels
  unsigned seed = 1;
};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
  [[nodiscard]] FrameView view() const { return {PixelFormat::rgb24, rgb.data(), width, height, width * 3}; }
};

/// The camera of the data sets, for paper_lens(): 0.58 m high, 30 degrees down.
CameraPose usual_pose();
Picture paint(const Scene& scene, const GroundProjection& projection, int width = 752, int height = 480);

/// The picture as the chain sees it, at 320x240.
struct WorkImage {
  int width = 0, height = 0;
  std::vector<std::uint8_t> y, cb, cr;
  [[nodiscard]] Yuv420View view();
};
WorkImage work_image(const Picture& picture, int width = 320, int height = 240);

}  // namespace touchline::test
