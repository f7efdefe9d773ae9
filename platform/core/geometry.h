// SPDX-License-Identifier: Apache-2.0
// Points have a type per frame of reference, so that a pixel is never taken for a metre.
//   camera pixels: (0, 0) is the top-left corner of the image, the centre of pixel (i, j) is (i + 0.5, j + 0.5)
//   ground: the robot's frame on the carpet, x forward, y left, metres; origin between the feet
//   field: origin at the centre mark, x to the opponent's goal, y to the left, metres
//   theta: 0 toward the opponent's goal, counter-clockwise, in (-pi, pi]
#pragma once

#include "platform/core/angle.h"
#include "platform/core/elementary.h"

namespace touchline {

struct PixelPoint {  // of the camera image, continuous
  float u = 0.0F;
  float v = 0.0F;
};
struct WorkPoint {  // of the subsampled working image, continuous; its pixels are not square
  float u = 0.0F;
  float v = 0.0F;
};
struct GroundPoint {  // robot's frame, metres
  float x = 0.0F;
  float y = 0.0F;
};
struct FieldPoint {  // field frame, metres
  float x = 0.0F;
  float y = 0.0F;
};
struct Pose2 {  // field_from_robot: metres, metres, radians. As an odometry step: robot_then_from_robot_now.
  float x = 0.0F;
  float y = 0.0F;
  float theta = 0.0F;
};
struct Vec3 {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
};
struct Mat3 {  // row-major
  float m[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
};
struct Sym2 {  // symmetric 2x2, e.g. a covariance in m^2
  float xx = 0.0F;
  float xy = 0.0F;
  float yy = 0.0F;
};

inline float dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 multiply(const Mat3& a, const Vec3& v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
inline Vec3 multiply_transposed(const Mat3& a, const Vec3& v) {
  return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
          a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}
Mat3 multiply(const Mat3& a, const Mat3& b);
/// Unit vector; the zero vector stays zero.
inline Vec3 normalized(const Vec3& v) {
  const float length = math::sqrt(dot(v, v));
  if (!(length > 0.0F)) return {};
  return {v.x / length, v.y / length, v.z / length};
}
/// Rotations by the right-hand rule about the named axis.
Mat3 rotation_x(float angle);
Mat3 rotation_y(float angle);
Mat3 rotation_z(float angle);

/// Where a ground point lies on the field when the robot stands at `field_from_robot`.
FieldPoint to_field(const Pose2& field_from_robot, const GroundPoint& p);
/// Where a field point lies in the robot's frame.
GroundPoint to_ground(const Pose2& field_from_robot, const FieldPoint& p);
/// a then b: pose_c_in_a = compose(pose_b_in_a, pose_c_in_b). theta is wrapped.
Pose2 compose(const Pose2& a, const Pose2& b);
/// compose(p, inverse(p)) is the identity.
Pose2 inverse(const Pose2& p);
/// The pose that the field's point symmetry cannot tell from `p`: (-x, -y, theta + pi).
Pose2 mirrored(const Pose2& p);

}  // namespace touchline
