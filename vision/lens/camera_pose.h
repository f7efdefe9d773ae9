// SPDX-License-Identifier: Apache-2.0
// How the camera hangs in the robot, for one frame, and the way from a pixel to the ground (inverse perspective
// mapping, paper section V-B).
#pragma once

#include "platform/core/geometry.h"
#include "vision/lens/lens.h"

namespace touchline {

/// The camera in the robot's frame. Its forward, left and up axes are the columns of Rz(yaw) Ry(pitch) Rx(roll).
struct CameraPose {
  float x = 0.0F;       // metres, forward of the robot's origin
  float y = 0.0F;       // metres, to the left of it
  float height = 0.0F;  // metres above the carpet, > 0
  float yaw = 0.0F;     // radians, > 0 looks left
  float pitch = 0.0F;   // radians, > 0 looks down
  float roll = 0.0F;    // radians, > 0 lowers the right side; any roll is legal
};

/// Rotation that takes a ray from the optical frame (x right, y down, z forward) to the robot's axes (x forward,
/// y left, z up).
Mat3 robot_from_camera(const CameraPose& pose);

/// A lens in a pose: everything needed to go between pixels and the ground for one frame.
class GroundProjection {
 public:
  // Sine of the smallest angle below the horizon that still counts as looking at the ground: 1e-4 is 5 km away at a
  // height of half a metre, and rounding of the ray stays a thousandth of it.
  static constexpr float min_descent = 1.0e-4F;

  GroundProjection() = default;
  GroundProjection(const Lens& lens, const CameraPose& pose);

  /// False when the pixel sees no ground: outside the lens, or at or above the horizon.
  [[nodiscard]] bool ground(const PixelPoint& pixel, GroundPoint& point) const;
  /// The ray of a pixel in the robot's axes (unit vector); false outside the lens.
  [[nodiscard]] bool robot_ray(const PixelPoint& pixel, Vec3& ray) const;
  /// The ground point where a ray of the robot's axes, from the camera, meets the carpet; false at or above the
  /// horizon.
  [[nodiscard]] bool intersect_ground(const Vec3& robot_ray, GroundPoint& point) const {
    if (!(robot_ray.z < -min_descent) || !(pose_.height > 0.0F)) return false;
    const float reach = pose_.height / -robot_ray.z;
    point = {pose_.x + reach * robot_ray.x, pose_.y + reach * robot_ray.y};
    return true;
  }
  /// False when the point lies beyond the lens.
  [[nodiscard]] bool pixel(const GroundPoint& point, PixelPoint& pixel) const;
  /// Likewise for a point `z` metres above the carpet.
  [[nodiscard]] bool pixel(const GroundPoint& point, float z, PixelPoint& pixel) const;
  /// pixel() of many ground points, bit for bit: takes x and y of `points` as those of the ground, and leaves rays
  /// there.
  void pixels(RayLanes& points) const;
  /// What `sigma_px` (camera pixels, along u and v each) and `sigma_tilt` (radians of pitch and of roll, each) mean on
  /// the ground there, m^2, to first order. A pixel that sees no ground: a million m^2 on the diagonal.
  [[nodiscard]] Sym2 ground_covariance(const PixelPoint& pixel, float sigma_px, float sigma_tilt) const;

  [[nodiscard]] const CameraPose& pose() const { return pose_; }
  [[nodiscard]] const Lens& lens() const { return lens_; }

 private:
  [[nodiscard]] Vec3 ray_slope(const PixelPoint& pixel, const Vec3& centre, float du, float dv) const;

  Lens lens_{};
  CameraPose pose_{};
  Mat3 rotation_{};  // robot_from_camera(pose_)
};

}  // namespace touchline
