// SPDX-License-Identifier: Apache-2.0
#include "vision/line_points.h"

#include <algorithm>
#include <cstdint>

#include "platform/core/elementary.h"
#include "vision/graph.h"
#include "vision/image/bit_ops.h"
#include "vision/image/moments.h"

namespace touchline {
namespace {

constexpr int direction_radius_px = 5;  // of the skeleton's pixels that give the direction, at a working width of 320
constexpr int max_half_width_px = 40;   // a line this wide fills the picture
constexpr int side_px = 2;              // how far beyond the mask's edge the carpet is sampled

struct Vec2 {
  float u = 0.0F, v = 0.0F;
};

/// Main axis of the skeleton's pixels within `radius`; false where they are few or no line: at ends, forks and bends,
/// where the middle of the line means nothing. `most_across` bounds the variance across as a share of that along.
bool main_axis(const LinePointInput& input, GridPoint at, int radius, float most_across, Vec2& direction) {
  const Moments m = moments_around(input.skeleton, at, radius, input.kernels);
  if (m.n < radius) return false;
  const float n = static_cast<float>(m.n);
  const float xx = static_cast<float>(m.n * m.xx - m.x * m.x) / (n * n);
  const float xy = static_cast<float>(m.n * m.xy - m.x * m.y) / (n * n);
  const float yy = static_cast<float>(m.n * m.yy - m.y * m.y) / (n * n);
  // Eigenvalues of the covariance: mean +- spread.
  const float mean = 0.5F * (xx + yy);
  const float half_difference = 0.5F * (xx - yy);
  const float spread = math::hypot(half_difference, xy);
  if (mean - spread > most_across * (mean + spread)) return false;
  const Vec2 axis = half_difference >= 0.0F ? Vec2{half_difference + spread, xy} : Vec2{xy, spread - half_difference};
  const float length = math::hypot(axis.u, axis.v);
  if (!(length > 0.0F)) return false;
  direction = {axis.u / length, axis.v / length};
  return true;
}

/// Unit direction of the skeleton at a pixel, in working pixels. A long stretch, where it is straight, halves the
/// error, which perspective makes several times larger on the ground; a short one does where lines bend or meet.
bool direction_at(const LinePointInput& input, GridPoint at, int radius, Vec2& direction) {
  // Of the variance along, 10 px^2 for a radius of 5: a staircase has 0.1 px^2 across, a line three pixels beside 2.2.
  return main_axis(input, at, 2 * radius, 0.015F, direction) || main_axis(input, at, radius, 0.08F, direction);
}

/// The luma and the mask along a straight line, in steps of an eighth of a pixel from a pixel's centre. Fixed point,
/// 1/65536.
class Profile {
 public:
  Profile(ImageView<const std::uint8_t> luma, ConstBitView mask, GridPoint from, const Vec2& along)
      : luma_(luma), mask_(mask), u_(from.x * one), v_(from.y * one), du_(fixed(along.u)), dv_(fixed(along.v)) {}

  /// Is there a luma sample (the middle of four pixels' centres) this far away?
  [[nodiscard]] bool inside(int eighths) const {
    const std::int32_t u = u_ + eighths * du_;
    const std::int32_t v = v_ + eighths * dv_;
    return u >= 0 && v >= 0 && u < (luma_.width - 1) * one && v < (luma_.height - 1) * one;
  }
  /// Bilinear, in 1/65536; where inside().
  [[nodiscard]] std::int32_t luma(int eighths) const {
    const std::int32_t u = u_ + eighths * du_;
    const std::int32_t v = v_ + eighths * dv_;
    const std::int32_t fu = (u >> 8) & 255;
    const std::int32_t fv = (v >> 8) & 255;
    const std::uint8_t* top = luma_.row(v >> 16) + (u >> 16);
    const std::uint8_t* bottom = top + luma_.stride;
    const std::int32_t upper = top[0] * 256 + fu * (top[1] - top[0]);
    const std::int32_t lower = bottom[0] * 256 + fu * (bottom[1] - bottom[0]);
    return upper * 256 + fv * (lower - upper);
  }
  /// How far the mask reaches, in whole pixels; `sign` 1 ahead, -1 back. Negative when it does not end within reach.
  [[nodiscard]] int mask_reach(int sign) const {
    std::int32_t u = u_ + one / 2;  // from the pixel's corner
    std::int32_t v = v_ + one / 2;
    for (int k = 1; k <= max_half_width_px; ++k) {
      u += sign * 8 * du_;
      v += sign * 8 * dv_;
      const int x = u >> 16;
      const int y = v >> 16;
      if (x < 0 || y < 0 || x >= mask_.width || y >= mask_.height) return -1;
      if (!mask_.get(x, y)) return k;
    }
    return -1;
  }

 private:
  static constexpr std::int32_t one = 65536;
  /// Of a part of a unit vector, in an eighth of a pixel.
  static std::int32_t fixed(float part) {
    const float scaled = part * (static_cast<float>(one) / 8.0F);
    return static_cast<std::int32_t>(scaled < 0.0F ? scaled - 0.5F : scaled + 0.5F);
  }
  ImageView<const std::uint8_t> luma_;
  ConstBitView mask_;
  std::int32_t u_, v_, du_, dv_;
};

/// Where the luma falls through the middle between the line's and the carpet's, in pixels ahead (`sign` 1) or back
/// (-1); false when it does not.
bool find_edge(const Profile& profile, int sign, int reach, std::int32_t line_level, float& edge) {
  constexpr int step = 4;  // half a pixel
  const int end = 8 * (reach + side_px);
  if (!profile.inside(sign * end)) return false;
  const std::int32_t near_end[2] = {profile.luma(sign * (end - step)), profile.luma(sign * (end - 2 * step))};
  const std::int32_t carpet = std::min({profile.luma(sign * end), near_end[0], near_end[1]});
  if (line_level <= carpet + 2 * 65536) return false;
  const std::int32_t level = (line_level + carpet) / 2;
  // Inward from the carpet, so that a hole in a worn line does no harm.
  std::int32_t outer = carpet;
  for (int k = 1; k * step <= end; ++k) {
    const std::int32_t inner = k <= 2 ? near_end[k - 1] : profile.luma(sign * (end - k * step));
    if (inner >= level) {
      const float share = static_cast<float>(level - outer) / static_cast<float>(inner - outer);
      const int steps_out = end / step - (k - 1);
      edge = 0.5F * (static_cast<float>(steps_out) - share);
      return true;
    }
    outer = inner;
  }
  return false;
}

/// How far the ground point moves per pixel along `d`: the derivative of height * ray.xy / -ray.z.
GroundPoint ground_slope(const RayPatch& at, const Vec2& d, float height) {
  const Vec3 change{d.u * at.by_u.x + d.v * at.by_v.x, d.u * at.by_u.y + d.v * at.by_v.y,
                    d.u * at.by_u.z + d.v * at.by_v.z};
  const float inverse_z = 1.0F / at.ray.z;
  const float reach = -height * inverse_z;
  const float share = change.z * inverse_z;
  return {reach * (change.x - at.ray.x * share), reach * (change.y - at.ray.y * share)};
}

class PointFinder {
 public:
  explicit PointFinder(const LinePointInput& input)
      : input_(input), radius_(std::clamp(direction_radius_px * input.luma.width / 320, 3, 7)) {}

  /// One skeleton pixel; counts the reason when there is no point.
  bool find(GridPoint pixel, LinePoint& point, LinePointCounts& counts) const {
    Vec2 tangent;
    if (!direction_at(input_, pixel, radius_, tangent)) return fail(counts.no_direction);
    return find_along(pixel, tangent, point, counts);
  }

  /// The same with the line's direction given.
  bool find_along(GridPoint pixel, const Vec2& tangent, LinePoint& point, LinePointCounts& counts) const {
    const Vec2 normal{-tangent.v, tangent.u};
    float edge_a = 0.0F;
    float edge_b = 0.0F;
    if (!find_edges(Profile(input_.luma, input_.line_mask, pixel, normal), edge_a, edge_b)) return fail(counts.no_edge);
    const float middle = 0.5F * (edge_a - edge_b);
    const Vec2 at{static_cast<float>(pixel.x) + 0.5F + middle * normal.u,
                  static_cast<float>(pixel.y) + 0.5F + middle * normal.v};
    return locate(at, tangent, normal, edge_a + edge_b, point, counts);
  }

 private:
  static bool fail(int& counter) {
    ++counter;
    return false;
  }

  /// Distances of the line's edges from the profile's start, ahead and back.
  static bool find_edges(const Profile& profile, float& ahead, float& back) {
    const int reach_a = profile.mask_reach(1);
    const int reach_b = profile.mask_reach(-1);
    if (reach_a < 0 || reach_b < 0) return false;
    // The samples of the level lie between those of the ends.
    if (!profile.inside(8 * (reach_a + side_px)) || !profile.inside(-8 * (reach_b + side_px))) return false;
    std::int32_t level = 0;  // of the line: the mean of its inner half, or the brightest of three where it is thin
    if (reach_a + reach_b <= 5) {
      for (int k = -2; k <= 2; ++k) level = std::max(level, profile.luma(4 * k));
    } else {
      const int centre = 4 * (reach_a - reach_b);
      std::int32_t sum = 0;
      for (int k = -2; k <= 2; ++k) sum += profile.luma(centre + k * (reach_a + reach_b));
      level = sum / 5;
    }
    return find_edge(profile, 1, reach_a, level, ahead) && find_edge(profile, -1, reach_b, level, back);
  }

  /// The ground under the line's edges, `half` pixels to both sides; the middle of both, and its place in the picture.
  bool find_middle(const Vec2& at, const Vec2& normal, float half, LinePoint& point) const {
    // By the lens itself: between the corners of the ray grid a millimetre would be lost.
    const GroundProjection& projection = input_.rays.projection();
    GroundPoint a, b;
    if (!projection.ground(input_.rays.camera_pixel({at.u + half * normal.u, at.v + half * normal.v}), a) ||
        !projection.ground(input_.rays.camera_pixel({at.u - half * normal.u, at.v - half * normal.v}), b)) {
      return false;
    }
    point.ground = {0.5F * (a.x + b.x), 0.5F * (a.y + b.y)};
    // Each edge counts in the picture by its distance from the camera.
    const CameraPose& pose = projection.pose();
    const auto distance = [&pose](const GroundPoint& g) {
      return math::sqrt(math::square(g.x - pose.x) + math::square(g.y - pose.y) + math::square(pose.height));
    };
    const float far_a = distance(a);
    const float far_b = distance(b);
    const float t = half * (far_a - far_b) / (far_a + far_b);
    point.pixel = input_.rays.camera_pixel({at.u + t * normal.u, at.v + t * normal.v});
    return true;
  }

  bool locate(const Vec2& middle, const Vec2& tangent, const Vec2& normal, float measured_px, LinePoint& point,
              LinePointCounts& counts) const {
    const CameraPose& pose = input_.rays.projection().pose();
    RayPatch patch;
    GroundPoint ground;
    if (!input_.rays.patch({middle.u, middle.v}, patch) ||
        !input_.rays.projection().intersect_ground(patch.ray, ground)) {
      return fail(counts.no_ground);
    }
    const GroundPoint run = ground_slope(patch, tangent, pose.height);
    const GroundPoint step = ground_slope(patch, normal, pose.height);
    const float length = math::hypot(run.x, run.y);
    if (!(length > 0.0F)) return fail(counts.no_ground);
    const float metres_a_px = math::abs(step.x * run.y - step.y * run.x) / length;
    if (!(metres_a_px > 0.0F)) return fail(counts.no_ground);
    const float expected_px = input_.line_width_m / metres_a_px;
    if (!right_width(measured_px, expected_px)) return fail(counts.wrong_width);
    // The middle of a wide line in the image is not the middle on the ground: perspective makes the near half wider.
    if (!find_middle(middle, normal, expected_px < 3.0F ? 0.5F : 0.5F * measured_px, point)) {
      return fail(counts.no_ground);
    }
    const float x = point.ground.x - pose.x;
    const float y = point.ground.y - pose.y;
    if (x * x + y * y > input_.max_range_m * input_.max_range_m) return fail(counts.no_ground);
    const float sign = run.x > 0.0F || (run.x == 0.0F && run.y > 0.0F) ? 1.0F : -1.0F;
    point.dir_x = sign * run.x / length;
    point.dir_y = sign * run.y / length;
    point.length = length;
    point.sigma = metres_a_px;
    return true;
  }

  /// Blur makes a line up to about a pixel wider than it is, wear makes it thinner.
  static bool right_width(float measured_px, float expected_px) {
    return measured_px < 1.35F * expected_px + 1.5F && measured_px > 0.55F * expected_px - 0.5F;
  }

  const LinePointInput& input_;
  int radius_;
};

}  // namespace

bool find_line_point(const LinePointInput& input, const WorkPoint& at, const WorkPoint& direction, LinePoint& point) {
  const float length = math::hypot(direction.u, direction.v);
  const ConstBitView& mask = input.line_mask;
  const bool inside =
      at.u >= 0.0F && at.v >= 0.0F && at.u < static_cast<float>(mask.width) && at.v < static_cast<float>(mask.height);
  if (!inside || !(length > 0.0F)) return false;
  const GridPoint pixel{static_cast<std::int16_t>(at.u), static_cast<std::int16_t>(at.v)};
  if (!mask.get(pixel.x, pixel.y)) return false;
  LinePointCounts counts;
  return PointFinder(input).find_along(pixel, {direction.u / length, direction.v / length}, point, counts);
}

LinePointCounts find_line_points(const LinePointInput& input, BitView scratch,
                                 StaticVector<LinePoint, max_line_points>& points) {
  LinePointCounts counts;
  points.clear();
  clear(scratch);
  // Evenly spread: on a skeleton of n pixels every n / 512-th.
  const int spacing = count(input.skeleton) / static_cast<int>(max_line_points) + 1;
  const auto pass_over = [&scratch](int x, int y, int reach) {
    for (int ny = y; ny < std::min(y + reach, scratch.height); ++ny)
      set_span(scratch, ny, x - reach + 1, x + reach - 1, true);
  };
  const PointFinder finder(input);
  for_each_set_bit(input.skeleton, [&](int x, int y) {
    if (scratch.get(x, y)) return;
    ++counts.considered;
    LinePoint point;
    const GridPoint pixel{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
    if (!finder.find(pixel, point, counts)) {
      // Beside a pixel without a point there may be one. Of the thousands of pixels of clutter not all are asked.
      pass_over(x, y, spacing / 4);
      return;
    }
    point.length *= static_cast<float>(spacing);
    points.push_back(point);
    pass_over(x, y, spacing);
  });
  counts.dropped = static_cast<int>(points.dropped());
  return counts;
}

}  // namespace touchline
