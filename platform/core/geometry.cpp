// SPDX-License-Identifier: Apache-2.0
#include "platform/core/geometry.h"

namespace touchline {

Mat3 multiply(const Mat3& a, const Mat3& b) {
  Mat3 product;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      product.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    }
  }
  return product;
}

Mat3 rotation_x(float angle) {
  const auto [s, c] = math::sin_cos(angle);
  return {{{1.0F, 0.0F, 0.0F}, {0.0F, c, -s}, {0.0F, s, c}}};
}

Mat3 rotation_y(float angle) {
  const auto [s, c] = math::sin_cos(angle);
  return {{{c, 0.0F, s}, {0.0F, 1.0F, 0.0F}, {-s, 0.0F, c}}};
}

Mat3 rotation_z(float angle) {
  const auto [s, c] = math::sin_cos(angle);
  return {{{c, -s, 0.0F}, {s, c, 0.0F}, {0.0F, 0.0F, 1.0F}}};
}

FieldPoint to_field(const Pose2& field_from_robot, const GroundPoint& p) {
  const auto [s, c] = math::sin_cos(field_from_robot.theta);
  return {field_from_robot.x + (c * p.x - s * p.y), field_from_robot.y + (s * p.x + c * p.y)};
}

GroundPoint to_ground(const Pose2& field_from_robot, const FieldPoint& p) {
  const auto [s, c] = math::sin_cos(field_from_robot.theta);
  const float dx = p.x - field_from_robot.x;
  const float dy = p.y - field_from_robot.y;
  return {c * dx + s * dy, c * dy - s * dx};
}

Pose2 compose(const Pose2& a, const Pose2& b) {
  const FieldPoint at = to_field(a, {b.x, b.y});
  return {at.x, at.y, wrap_angle(a.theta + b.theta)};
}

Pose2 inverse(const Pose2& p) {
  const GroundPoint origin = to_ground(p, {0.0F, 0.0F});
  return {origin.x, origin.y, wrap_angle(-p.theta)};
}

Pose2 mirrored(const Pose2& p) { return {-p.x, -p.y, wrap_angle(p.theta + math::pi)}; }

}  // namespace touchline
