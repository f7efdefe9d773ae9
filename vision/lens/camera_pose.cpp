// SPDX-License-Identifier: Apache-2.0
// Inverse perspective mapping (paper section V-B) done with rays: a pixel's ray is turned into the robot's axes and cut
// with the carpet. So it holds for any lens and any roll, and knows the horizon by itself.
#include "vision/lens/camera_pose.h"

#include "platform/core/elementary.h"

namespace touchline {
namespace {

constexpr float no_ground_variance = 1.0e6F;  // m^2

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Vec3 difference(const Vec3& a, const Vec3& b, float scale) {
  return {(a.x - b.x) * scale, (a.y - b.y) * scale, (a.z - b.z) * scale};
}

/// How far the ground point moves when the ray `d` changes by `change`: the derivative of height * d.xy / -d.z.
GroundPoint ground_shift(const Vec3& d, const Vec3& change, float height) {
  const float reach = height / -d.z;
  return {reach * (change.x - d.x / d.z * change.z), reach * (change.y - d.y / d.z * change.z)};
}

void add_outer(Sym2& sum, const GroundPoint& v) {
  sum.xx += v.x * v.x;
  sum.xy += v.x * v.y;
  sum.yy += v.y * v.y;
}

}  // namespace

Mat3 robot_from_camera(const CameraPose& pose) {
  const Mat3 axes = multiply(rotation_z(pose.yaw), multiply(rotation_y(pose.pitch), rotation_x(pose.roll)));
  // Columns of `axes`: forward, left, up. Optical x is right, y is down, z is forward.
  Mat3 rotation;
  for (int i = 0; i < 3; ++i) {
    rotation.m[i][0] = -axes.m[i][1];
    rotation.m[i][1] = -axes.m[i][2];
    rotation.m[i][2] = axes.m[i][0];
  }
  return rotation;
}

GroundProjection::GroundProjection(const Lens& lens, const CameraPose& pose)
    : lens_(lens), pose_(pose), rotation_(robot_from_camera(pose)) {}

bool GroundProjection::robot_ray(const PixelPoint& pixel, Vec3& ray) const {
  Vec3 camera_ray;
  if (!lens_.ray(pixel, camera_ray)) return false;
  ray = multiply(rotation_, camera_ray);
  return true;
}

bool GroundProjection::ground(const PixelPoint& pixel, GroundPoint& point) const {
  Vec3 ray;
  return robot_ray(pixel, ray) && intersect_ground(ray, point);
}

bool GroundProjection::pixel(const GroundPoint& point, PixelPoint& pixel) const {
  return this->pixel(point, 0.0F, pixel);
}

bool GroundProjection::pixel(const GroundPoint& point, float z, PixelPoint& pixel) const {
  const Vec3 robot_ray{point.x - pose_.x, point.y - pose_.y, z - pose_.height};
  return lens_.pixel(multiply_transposed(rotation_, robot_ray), pixel);
}

void GroundProjection::pixels(RayLanes& points) const {
  points.pad();
  const int count = points.padded();
  const float down = 0.0F - pose_.height;
  for (int i = 0; i < count; ++i) {
    const Vec3 ray = multiply_transposed(rotation_, {points.x[i] - pose_.x, points.y[i] - pose_.y, down});
    points.x[i] = ray.x;
    points.y[i] = ray.y;
    points.z[i] = ray.z;
  }
  lens_.pixels(points);
}

/// How the ray changes a pixel, by central differences over one pixel; one-sided at the edge of the lens.
Vec3 GroundProjection::ray_slope(const PixelPoint& pixel, const Vec3& centre, float du, float dv) const {
  Vec3 ahead = centre;
  Vec3 behind = centre;
  const bool has_ahead = robot_ray({pixel.u + 0.5F * du, pixel.v + 0.5F * dv}, ahead);
  const bool has_behind = robot_ray({pixel.u - 0.5F * du, pixel.v - 0.5F * dv}, behind);
  return difference(ahead, behind, has_ahead && has_behind ? 1.0F : 2.0F);
}

Sym2 GroundProjection::ground_covariance(const PixelPoint& pixel, float sigma_px, float sigma_tilt) const {
  Vec3 ray;
  GroundPoint unused;
  if (!robot_ray(pixel, ray) || !intersect_ground(ray, unused)) return {no_ground_variance, 0.0F, no_ground_variance};
  // Pitch turns about the left axis after yaw, roll about the camera's forward axis.
  const auto [sin_yaw, cos_yaw] = math::sin_cos(pose_.yaw);
  const Vec3 pitch_axis{-sin_yaw, cos_yaw, 0.0F};
  const Vec3 roll_axis{rotation_.m[0][2], rotation_.m[1][2], rotation_.m[2][2]};
  const Vec3 by_u = ray_slope(pixel, ray, 1.0F, 0.0F);
  const Vec3 by_v = ray_slope(pixel, ray, 0.0F, 1.0F);
  const Vec3 by_pitch = cross(pitch_axis, ray);
  const Vec3 by_roll = cross(roll_axis, ray);

  Sym2 by_pixel;
  add_outer(by_pixel, ground_shift(ray, by_u, pose_.height));
  add_outer(by_pixel, ground_shift(ray, by_v, pose_.height));
  Sym2 by_tilt;
  add_outer(by_tilt, ground_shift(ray, by_pitch, pose_.height));
  add_outer(by_tilt, ground_shift(ray, by_roll, pose_.height));
  const float p = sigma_px * sigma_px;
  const float t = sigma_tilt * sigma_tilt;
  return {p * by_pixel.xx + t * by_tilt.xx, p * by_pixel.xy + t * by_tilt.xy, p * by_pixel.yy + t * by_tilt.yy};
}

}  // namespace touchline
