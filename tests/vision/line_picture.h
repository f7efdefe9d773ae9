// SPDX-License-Identifier: Apache-2.0
// What the line points are made from, straight from a painted scene: the line mask is what is brighter than half way
// between carpet and white. Test support: heap is fine here.
#pragma once

#include <array>
#include <vector>

#include "platform/core/elementary.h"
#include "tests/support/ascii_image.h"
#include "tests/support/thinning_memory.h"
#include "tests/vision/painted_field.h"
#include "vision/image/thinning.h"
#include "vision/line_points.h"

namespace touchline::test {

class LinePicture {
 public:
  LinePicture(const Scene& scene, const CameraPose& pose, int width = 320, int height = 240)
      : w(width),
        h(height),
        projection_(paper_lens(), pose),
        image_(work_image(paint(scene, projection_), w, h)),
        mask_(w, h),
        corners_(static_cast<std::size_t>(ray_columns(w) * ray_rows(h))),
        rays_(projection_, make_grid(), frame_w, frame_h, w, h) {
    for (int y = 0; y < h; ++y) {
      for (int x = 0; x < w; ++x) mask_.view().set(x, y, is_line(x, y));
    }
    skeleton_ = mask_;
    OwnThinningMemory thinning(w, h);
    thin(skeleton_.view(), thinning.memory());
  }
  LinePicture(const LinePicture&) = delete;  // the rays look at the projection
  LinePicture& operator=(const LinePicture&) = delete;

  [[nodiscard]] LinePointInput input(float line_width) {
    return {image_.view().y, skeleton_.view(), mask_.view(), rays_, line_width, 6.0F};
  }
  const int w, h;

 private:
  static constexpr int frame_w = 752, frame_h = 480;

  [[nodiscard]] RayGridView make_grid() {
    const RayGridView grid{corners_, ray_columns(w), ray_rows(h)};
    make_ray_grid(paper_lens(), frame_w, frame_h, w, h, grid);
    return grid;
  }
  [[nodiscard]] bool is_line(int x, int y) const {
    GroundPoint g;
    const PixelPoint pixel{(static_cast<float>(x) + 0.5F) * static_cast<float>(frame_w) / static_cast<float>(w),
                           (static_cast<float>(y) + 0.5F) * static_cast<float>(frame_h) / static_cast<float>(h)};
    if (!projection_.ground(pixel, g) || math::hypot(g.x, g.y) > 3.0F) return false;
    return image_.y[static_cast<std::size_t>(y * w + x)] > 140;
  }

  GroundProjection projection_;
  WorkImage image_;
  Bits mask_, skeleton_;
  std::vector<Vec3> corners_;
  WorkRays rays_;
};

}  // namespace touchline::test
