// SPDX-License-Identifier: Apache-2.0
// Draws what a fish-eye camera sees of a scene: one ray a pixel against ground, room and solids; four where solids end.
#pragma once

#include <cstdint>
#include <vector>

#include "platform/core/frame.h"
#include "platform/host/sim/develop.h"
#include "platform/host/sim/lens_map.h"
#include "platform/host/sim/scene.h"
#include "vision/lens/camera_pose.h"

namespace touchline::sim {

class SimRenderer {
 public:
  /// Computes the rays of all pixels; about 50 ms, once per lens.
  void set_lens(const Lens& lens, int width, int height);
  /// One frame from a robot at `robot` with the camera at `camera` in it. The same arguments give the same bytes.
  /// `rgb` becomes width * height * 3 bytes, RGB24. set_lens must have been called.
  void render(const Scene& scene, const Pose2& robot, const CameraPose& camera, const ImageEffects& effects,
              std::uint64_t noise_seed, std::vector<std::uint8_t>& rgb);
  [[nodiscard]] const LensMap& lens_map() const { return map_; }

 private:
  using Identity = std::uint16_t;  // of what a pixel shows: 0 ground, 1..5 walls, then 8 a solid

  struct Bound {  // a solid's bounding sphere, seen from the camera
    Vec3 to;      // its centre
    float clear2 =
        0.0F;  // squared distance along a ray below which the ray passes beside it; < 0: the camera is inside
  };
  struct Row {  // rays in the field's axes, and where they meet the ground
    std::vector<float> x, y, z, ground_x, ground_y;
    void resize(int width);
  };
  void trace_row(int y, Row& row) const;
  void find_candidates(const Scene& scene);
  [[nodiscard]] Footprint footprint(const Row& row, const Row& below, int x) const;
  void shade_row(const Scene& scene, int y, const Row& row, const Row& below);
  /// The colour in a direction, and what is seen there.
  [[nodiscard]] Rgb shade(const Scene& scene, int tile, const Vec3& direction, const Footprint& pixel,
                          Identity& identity) const;
  void supersample_row(const Scene& scene, int y);
  [[nodiscard]] Rgb supersampled(const Scene& scene, int x, int y) const;
  [[nodiscard]] bool differs(int x, int y) const;
  void store(int x, int y, const Rgb& color, float cosine);

  LensMap map_;
  Developer developer_;
  ImageEffects effects_;
  Mat3 rotation_;  // field_from_camera
  Vec3 origin_;    // camera in the field frame
  LightRows light_;
  std::vector<Identity> identity_;
  std::vector<Bound> bounds_;
  std::vector<std::uint32_t> tile_start_;
  std::vector<std::uint16_t> tile_solids_;
  Row rows_[2];
};

/// Converts RGB24 to another format of the same size; yuyv needs an even width. `out` is resized.
void convert_rgb24(const std::vector<std::uint8_t>& rgb, int width, int height, PixelFormat to,
                   std::vector<std::uint8_t>& out);

}  // namespace touchline::sim
