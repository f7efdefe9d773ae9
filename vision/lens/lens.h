// SPDX-License-Identifier: Apache-2.0
// Which ray does this pixel see? One question, one shape for every lens model (paper section V-B; reading: a lens of
// 185 degrees has no rectilinear image beyond 90, so every model answers with a ray).
// Rays are unit vectors in the camera's optical frame: x right, y down, z along the optical axis.
#pragma once

#include <array>
#include <cstdint>

#include "platform/core/geometry.h"
#include "platform/core/status.h"
#include "vision/image/vector_registers.h"

namespace touchline {

enum class LensModel : std::uint8_t {
  equidistant,     // r = f theta
  equisolid,       // r = 2 f sin(theta / 2)
  rectilinear,     // r = f tan(theta)
  kannala_brandt,  // r = f (theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9)
  barrel,          // eq. (2): r_c = r_d / (1 - alpha r_d^2), theta = atan(r_c / f)
  polynomial,      // eqs. (3)-(4): r_c = sum a_i r_d^i, phi_c = sum b_i phi_d^i, theta = atan(r_c / f)
};

struct LensParameters {
  LensModel model = LensModel::equidistant;
  float focal_px = 0.0F;
  float cx = 0.0F;  // principal point, continuous camera pixels
  float cy = 0.0F;
  float max_theta = 0.0F;    // radians, at most pi; nothing is seen beyond. Lens::create lowers it to 89.9 degrees for
                             // the models that go through the pinhole's image (rectilinear, barrel, polynomial)
  std::array<float, 4> k{};  // kannala_brandt: k1..k4
  float alpha = 0.0F;        // barrel: 1/px^2
  std::array<float, 8> a{};  // polynomial: a0..a7 (degree 5: the last two are 0)
  std::array<float, 8> b{0.0F, 1.0F};  // polynomial: b0..b7
};

/// Some rays and the pixels where they end, side by side for vectors.
struct RayLanes {
  static constexpr int most = vector_registers ? 16 : 8;
  static constexpr int width = vector_registers ? 4 : 1;  // of the vectors that every processor with vectors has
  int count = 0;
  float x[most + width], y[most + width], z[most + width];  // with room for pad()
  float u[most], v[most];
  std::int32_t seen[most];  // 1, or 0 where the ray is beyond max_theta: then u and v say nothing
  /// A point on the carpet, for those who take x and y as that.
  void add(const GroundPoint& p) {
    x[count] = p.x;
    y[count++] = p.y;
  }
  /// `count`, up to whole vectors.
  [[nodiscard]] int padded() const { return (count + width - 1) / width * width; }
  /// Fills the last vector with rays that end nowhere: always as many as a vector has, which takes no loop.
  void pad() {
    if constexpr (width == 1) return;
    for (int i = 0; i < width; ++i) x[count + i] = y[count + i] = z[count + i] = 0.0F;
  }
};

/// A lens whose parameters were checked. Copyable, small, no state beyond the parameters and what follows from them.
class Lens {
 public:
  Lens() = default;
  /// invalid_argument: focal length, centre or angle not finite or out of range, or the model is not monotonic up to
  /// max_theta (then the reason is in `what`, a static string, when it is not null).
  static Status create(const LensParameters& parameters, Lens& out, const char** what = nullptr);

  /// False when no ray within max_theta ends at this pixel; then `ray` is unchanged.
  [[nodiscard]] bool ray(const PixelPoint& pixel, Vec3& ray) const;
  /// False when the ray is beyond max_theta; then `pixel` is unchanged. `ray` need not be a
  /// unit vector; the zero vector ends nowhere.
  [[nodiscard]] bool pixel(const Vec3& ray, PixelPoint& pixel) const;
  /// pixel() of many rays, bit for bit.
  void pixels(RayLanes& rays) const;
  /// The first half of ray(), for many pixels: angles off the axis, from distances to the principal point (those beyond
  /// max_radius() count as it). `u` and `v`, offsets from that point, turn where the lens bends the polar angle.
  void angles(int count, const float* radius, float* u, float* v, float* theta) const;
  /// Radius of the image circle, camera pixels.
  [[nodiscard]] float max_radius() const { return max_radius_; }
  [[nodiscard]] const LensParameters& parameters() const { return parameters_; }

 private:
  LensParameters parameters_{};
  float max_radius_ = 0.0F;
  bool bends_angle_ = false;  // b of the polynomial is not the identity
};

}  // namespace touchline
