// SPDX-License-Identifier: Apache-2.0
#include "vision/line_points.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#include "platform/core/elementary.h"
#include "vision/graph.h"
#include "vision/image/bit_ops.h"

namespace touchline {
namespace {

constexpr int direction_radius_px = 5;  // of the skeleton's pixels that give the direction, at a working width of 320
constexpr int max_half_width_px = 40;   // a line this wide fills the picture
constexpr float side_px = 2.0F;         // how far beyond the mask's edge the carpet is sampled

struct Vec2 {
  float u = 0.0F, v = 0.0F;
};

/// Second moments of the skeleton's pixels around one of them.
struct Moments {
  std::int32_t n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
};
/// A window of up to 32 columns of a mask; bits outside the image are zero. A word of 32 bits is what a register of a
/// small processor takes.
class BitWindow {
 public:
  BitWindow(ConstBitView mask, int first, int n) : mask_(mask) {
    const int from = std::max(first, 0);
    left_ = from / 32 * 4;
    right_ = from / 32 * 32 + 32 < mask.width ? left_ + 4 : left_;
    inside_left_ = from < mask.width ? ~std::uint32_t{0} : 0;
    inside_right_ = right_ != left_ && from % 32 != 0 ? ~std::uint32_t{0} : 0;
    if (inside_left_ == 0) left_ = right_ = 0;
    down_ = from % 32;
    up_ = (32 - down_) % 32;
    before_ = from - first;
    window_ = ~std::uint32_t{0} >> (32 - n);
  }
  [[nodiscard]] std::uint32_t row(int y) const {
    const auto* bytes = reinterpret_cast<const unsigned char*>(mask_.row(y));
    const std::uint32_t left = load(bytes + left_) & inside_left_;
    const std::uint32_t right = load(bytes + right_) & inside_right_;
    return ((left >> down_ | right << up_) << before_) & window_;
  }

 private:
  static std::uint32_t load(const unsigned char* from) {
    std::uint32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    return word;
  }
  ConstBitView mask_;
  int left_, right_;  // bytes
  std::uint32_t inside_left_, inside_right_, window_;
  int down_, up_, before_;
};

Moments moments_around(ConstBitView skeleton, GridPoint at, int radius) {
  Moments m;
  const BitWindow window(skeleton, at.x - radius, 2 * radius + 1);
  for (int dy = std::max(-radius, -at.y); dy <= std::min(radius, skeleton.height - 1 - at.y); ++dy) {
    std::int32_t n = 0, x = 0;
    for (std::uint32_t left = window.row(at.y + dy); left != 0; left &= left - 1) {
      const int dx = std::countr_zero(left) - radius;
      ++n;
      x += dx;
      m.xx += dx * dx;
    }
    m.n += n;
    m.x += x;
    m.y += n * dy;
    m.xy += x * dy;
    m.yy += n * dy * dy;
  }
  return m;
}

/// Main axis of the skeleton's pixels within `radius`; false where they are few or no line: at ends, forks and bends,
/// where the middle of the line means nothing. `most_across` bounds the variance across as a share of that along.
bool main_axis(ConstBitView skeleton, GridPoint at, int radius, float most_across, Vec2& direction) {
  const Moments m = moments_around(skeleton, at, radius);
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

/// Unit direction of the skeleton at a pixel, in working pixels. A short stretch says whether there is one; a longer
/// one, where it is straight, halves the error, which perspective makes several times larger on the ground.
bool direction_at(ConstBitView skeleton, GridPoint at, int radius, Vec2& direction) {
  // Of the variance along, 10 px^2 for a radius of 5: a staircase has 0.1 px^2 across, a line three pixels beside 2.2.
  if (!main_axis(skeleton, at, radius, 0.08F, direction)) return false;
  Vec2 longer;
  if (main_axis(skeleton, at, 2 * radius, 0.015F, longer)) direction = longer;
  return true;
}

/// Bilinear luma at a continuous working pixel; negative outside the image.
float luma_at(ImageView<const std::uint8_t> luma, const Vec2& p) {
  const float x = p.u - 0.5F;
  const float y = p.v - 0.5F;
  if (x < 0.0F || y < 0.0F) return -1.0F;
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  if (ix + 1 >= luma.width || iy + 1 >= luma.height) return -1.0F;
  const float fx = x - static_cast<float>(ix);
  const float fy = y - static_cast<float>(iy);
  const std::uint8_t* top = luma.row(iy) + ix;
  const std::uint8_t* bottom = luma.row(iy + 1) + ix;
  const float upper = static_cast<float>(top[0]) + fx * static_cast<float>(top[1] - top[0]);
  const float lower = static_cast<float>(bottom[0]) + fx * static_cast<float>(bottom[1] - bottom[0]);
  return upper + fy * (lower - upper);
}

Vec2 along(const Vec2& p, const Vec2& d, float t) { return {p.u + d.u * t, p.v + d.v * t}; }

/// How far the mask reaches from `p` along `d`, in whole steps; negative when it does not end within reach.
int mask_reach(ConstBitView mask, const Vec2& p, const Vec2& d) {
  for (int k = 1; k <= max_half_width_px; ++k) {
    const Vec2 q = along(p, d, static_cast<float>(k));
    if (q.u < 0.0F || q.v < 0.0F) return -1;
    const int x = static_cast<int>(q.u);
    const int y = static_cast<int>(q.v);
    if (x >= mask.width || y >= mask.height) return -1;
    if (!mask.get(x, y)) return k;
  }
  return -1;
}

/// Where the luma falls through the middle between the line's and the carpet's, along `d` from `p`; false when it does
/// not.
bool find_edge(ImageView<const std::uint8_t> luma, const Vec2& p, const Vec2& d, int reach, float line_level,
               float& edge) {
  const float end = static_cast<float>(reach) + side_px;
  const float carpet_a = luma_at(luma, along(p, d, end - 0.5F));
  const float carpet_b = luma_at(luma, along(p, d, end - 1.0F));
  const float carpet_c = luma_at(luma, along(p, d, end));
  if (carpet_a < 0.0F || carpet_b < 0.0F || carpet_c < 0.0F) return false;
  const float carpet = math::min(carpet_a, math::min(carpet_b, carpet_c));
  if (line_level <= carpet + 2.0F) return false;
  const float level = 0.5F * (line_level + carpet);
  constexpr float step = 0.5F;
  // Inward from the carpet, so that a hole in a worn line does no harm.
  float t = end;
  float outer = carpet;
  while (t > 0.0F) {
    const float inner = luma_at(luma, along(p, d, t - step));
    if (inner >= level && outer < level) {
      edge = t - step * (level - outer) / (inner - outer);
      return true;
    }
    outer = inner;
    t -= step;
  }
  return false;
}

class PointFinder {
 public:
  explicit PointFinder(const LinePointInput& input)
      : input_(input),
        scale_u_(static_cast<float>(input.frame_width) / static_cast<float>(input.luma.width)),
        scale_v_(static_cast<float>(input.frame_height) / static_cast<float>(input.luma.height)),
        radius_(std::clamp(direction_radius_px * input.luma.width / 320, 3, 7)) {}

  /// One skeleton pixel; counts the reason when there is no point.
  bool find(GridPoint pixel, LinePoint& point, LinePointCounts& counts) const {
    Vec2 tangent;
    if (!direction_at(input_.skeleton, pixel, radius_, tangent)) return fail(counts.no_direction);
    const Vec2 normal{-tangent.v, tangent.u};
    const Vec2 start{static_cast<float>(pixel.x) + 0.5F, static_cast<float>(pixel.y) + 0.5F};
    Vec2 middle;
    float measured_px = 0.0F;
    if (!find_middle(start, normal, middle, measured_px)) return fail(counts.no_edge);
    return locate(middle, tangent, normal, measured_px, point, counts);
  }

 private:
  static bool fail(int& counter) {
    ++counter;
    return false;
  }

  bool find_middle(const Vec2& start, const Vec2& normal, Vec2& middle, float& measured_px) const {
    const Vec2 back{-normal.u, -normal.v};
    const int reach_a = mask_reach(input_.line_mask, start, normal);
    const int reach_b = mask_reach(input_.line_mask, start, back);
    if (reach_a < 0 || reach_b < 0) return false;
    float level = 0.0F;  // of the line: the mean of its inner half, or the brightest of three where it is thin
    if (reach_a + reach_b <= 5) {
      for (int k = -2; k <= 2; ++k)
        level = math::max(level, luma_at(input_.luma, along(start, normal, 0.5F * static_cast<float>(k))));
    } else {
      const float centre = 0.5F * static_cast<float>(reach_a - reach_b);
      const float quarter = 0.25F * static_cast<float>(reach_a + reach_b);
      float sum = 0.0F;
      for (int k = -2; k <= 2; ++k)
        sum += luma_at(input_.luma, along(start, normal, centre + 0.5F * quarter * static_cast<float>(k)));
      level = sum / 5.0F;
    }
    float edge_a = 0.0F;
    float edge_b = 0.0F;
    if (!find_edge(input_.luma, start, normal, reach_a, level, edge_a)) return false;
    if (!find_edge(input_.luma, start, back, reach_b, level, edge_b)) return false;
    middle = along(start, normal, 0.5F * (edge_a - edge_b));
    measured_px = edge_a + edge_b;
    return true;
  }

  [[nodiscard]] PixelPoint camera(const Vec2& work) const { return {work.u * scale_u_, work.v * scale_v_}; }

  bool locate(const Vec2& middle, const Vec2& tangent, const Vec2& normal, float measured_px, LinePoint& point,
              LinePointCounts& counts) const {
    const GroundProjection& projection = input_.projection;
    GroundPoint before, after, left, right;
    if (!projection.ground(camera(along(middle, tangent, -1.0F)), before) ||
        !projection.ground(camera(along(middle, tangent, 1.0F)), after) ||
        !projection.ground(camera(along(middle, normal, -0.5F)), left) ||
        !projection.ground(camera(along(middle, normal, 0.5F)), right)) {
      return fail(counts.no_ground);
    }
    const float run_x = after.x - before.x;
    const float run_y = after.y - before.y;
    const float run = math::hypot(run_x, run_y);
    if (!(run > 0.0F)) return fail(counts.no_ground);
    const float metres_a_px = math::abs((right.x - left.x) * run_y - (right.y - left.y) * run_x) / run;
    if (!(metres_a_px > 0.0F)) return fail(counts.no_ground);
    const float expected_px = input_.line_width_m / metres_a_px;
    if (!right_width(measured_px, expected_px)) return fail(counts.wrong_width);

    // The middle of a wide line in the image is not the middle on the ground: perspective makes the near half wider.
    GroundPoint edge_a, edge_b;
    if (!projection.ground(camera(along(middle, normal, 0.5F * measured_px)), edge_a) ||
        !projection.ground(camera(along(middle, normal, -0.5F * measured_px)), edge_b)) {
      return fail(counts.no_ground);
    }
    if (expected_px < 3.0F) {
      edge_a = right;
      edge_b = left;
    }
    point.ground = {0.5F * (edge_a.x + edge_b.x), 0.5F * (edge_a.y + edge_b.y)};
    const CameraPose& pose = projection.pose();
    if (math::hypot(point.ground.x - pose.x, point.ground.y - pose.y) > input_.max_range_m)
      return fail(counts.no_ground);
    if (!projection.pixel(point.ground, point.pixel)) return fail(counts.no_ground);
    point.ray = normalized({point.ground.x - pose.x, point.ground.y - pose.y, -pose.height});
    float direction = math::atan2(run_y, run_x);
    if (direction > half_turn) direction -= 2.0F * half_turn;
    if (direction <= -half_turn) direction += 2.0F * half_turn;
    point.direction = direction;
    point.length = 0.5F * run;
    point.sigma = metres_a_px;
    return true;
  }

  /// Blur makes a line up to about a pixel wider than it is, wear makes it thinner.
  static bool right_width(float measured_px, float expected_px) {
    return measured_px < 1.35F * expected_px + 1.5F && measured_px > 0.55F * expected_px - 0.5F;
  }

  static constexpr float half_turn = 1.57079633F;  // directions of a line repeat after pi
  const LinePointInput& input_;
  float scale_u_;
  float scale_v_;
  int radius_;
};

}  // namespace

LinePointCounts find_line_points(const LinePointInput& input, BitView scratch,
                                 StaticVector<LinePoint, max_line_points>& points) {
  LinePointCounts counts;
  points.clear();
  clear(scratch);
  // Evenly spread: on a skeleton of n pixels every n / 512-th.
  const int spacing = count(input.skeleton) / static_cast<int>(max_line_points) + 1;
  const PointFinder finder(input);
  for_each_set_bit(input.skeleton, [&](int x, int y) {
    if (scratch.get(x, y)) return;
    ++counts.considered;
    LinePoint point;
    const GridPoint pixel{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
    if (!finder.find(pixel, point, counts)) return;
    point.length *= static_cast<float>(spacing);
    points.push_back(point);
    for (int ny = y; ny < std::min(y + spacing, scratch.height); ++ny) {
      set_span(scratch, ny, x - spacing + 1, x + spacing - 1, true);
    }
  });
  counts.dropped = static_cast<int>(points.dropped());
  return counts;
}

}  // namespace touchline
