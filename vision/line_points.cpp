// SPDX-License-Identifier: Apache-2.0
#include "vision/line_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdint>

#include "platform/core/elementary.h"
#include "vision/graph.h"
#include "vision/image/bit_ops.h"
#include "vision/image/moments.h"

namespace touchline {
namespace {

// Of the skeleton's pixels that give the direction, at a working width of 320. From 448 on it stays 7: a staircase is
// as high in every picture, and the cost grows with the square.
constexpr int direction_radius_px = 5;
// Of the variance along, 10 px^2 for a radius of 5: a staircase has 0.1 px^2 across, a line three pixels beside 2.2.
constexpr float long_most_across = 0.015F;
constexpr float short_most_across = 0.08F;

const std::uint8_t* bytes_of(const ConstBitView& mask) { return reinterpret_cast<const std::uint8_t*>(mask.words); }

ProbePicture picture_of(const LinePointInput& input) {
  return {input.luma.data,
          bytes_of(input.line_mask),
          static_cast<std::int32_t>(input.luma.stride),
          input.line_mask.stride * bits_per_word / 8,
          input.luma.width,
          input.luma.height,
          probe_half_width_px * std::max(input.luma.width, 320) / 320};
}

ProbeView view_of(const LinePointInput& input) {
  const WorkRays& rays = input.rays;
  const CameraPose& pose = rays.projection().pose();
  const Lens& lens = rays.projection().lens();
  static_assert(sizeof(Vec3) == 3 * sizeof(float), "the loops take the grid as floats");
  const PixelPoint per_work = rays.camera_pixel({1.0F, 1.0F});
  return {&rays.grid().rays[0].x,
          rays.grid().columns,
          rays.grid().rows,
          rays.robot_from_camera(),
          pose.x,
          pose.y,
          pose.height,
          per_work.u,
          per_work.v,
          lens.parameters().cx,
          lens.parameters().cy,
          lens.max_radius(),
          input.line_width_m,
          input.max_range_m};
}

/// Up to sixteen pixels at a time.
class PointFinder {
 public:
  explicit PointFinder(const LinePointInput& input)
      : input_(input),
        picture_(picture_of(input)),
        view_(view_of(input)),
        radius_(std::clamp(direction_radius_px * input.luma.width / 320, 3, 7)) {}

  /// Skeleton pixels; those that stay alive have a point.
  void find(LineProbes& probes) const {
    std::fill_n(probes.state, probe_lanes, probe_no_direction);
    // A long stretch, where it is straight, halves the direction's error, which perspective makes several times larger
    // on the ground; a short one does where lines bend or meet.
    find_axes(2 * radius_, long_most_across, probes);
    find_axes(radius_, short_most_across, probes);
    find_along(probes);
  }

  /// The same with the lines' directions given, and `state` alive.
  void find_along(LineProbes& probes) const {
    const ProbeKernels& kernels = input_.kernels.probes;
    kernels.edges(picture_, probes);
    kernels.widths(view_, probes);
    for (int side = 0; side < 2; ++side) {
      input_.rays.projection().lens().angles(probes.count, probes.radius[side], probes.edge_u[side],
                                             probes.edge_v[side], probes.theta[side]);
    }
    kernels.places(view_, probes);
  }

  [[nodiscard]] LinePoint point(const LineProbes& p, int i) const {
    LinePoint point;
    point.pixel = input_.rays.camera_pixel(
        {p.middle_u[i] - p.off_middle[i] * p.tangent_v[i], p.middle_v[i] + p.off_middle[i] * p.tangent_u[i]});
    point.ground = {p.ground_x[i], p.ground_y[i]};
    point.dir_x = p.dir_x[i];
    point.dir_y = p.dir_y[i];
    point.length = p.length[i];
    point.sigma = p.across[i];
    return point;
  }

 private:
  /// Main axis of the skeleton's pixels within `radius`, for those without a direction. None where they are few or no
  /// line: at ends, forks and bends, where the middle of the line means nothing.
  void find_axes(int radius, float most_across, LineProbes& probes) const {
    ProbeMoments all;
    const WindowParts parts = parts_of(radius);
    std::array<ProbeWindows, 2> windows;
    std::uint32_t asked = 0;
    for (int i = 0; i < probes.count; ++i) {
      if (probes.state[i] == probe_alive) continue;
      const GridPoint at{static_cast<std::int16_t>(probes.x[i]), static_cast<std::int16_t>(probes.y[i])};
      if (input_.kernels.probes.moments != nullptr && make_windows(at, parts, radius, i, windows)) {
        asked |= 1U << i;
      } else {
        add(moments_around(input_.skeleton, at, radius, input_.kernels), i, all);
      }
    }
    for (int k = 0; k < parts.count && asked != 0; ++k) {
      ProbeWindows& part = windows[static_cast<std::size_t>(k)];
      const WindowColumns& columns = parts.part[static_cast<std::size_t>(k)];
      part.bytes = bytes_of(input_.skeleton);
      part.stride = input_.skeleton.stride * bits_per_word / 8;
      part.columns = columns.count;
      part.radius = radius;
      part.asked = asked;
      sum_windows(part, columns.middle(), all);
    }
    input_.kernels.probes.axes(all, radius, most_across, probes);
  }

  /// A probe's windows; false when one of them is not wholly inside the mask's memory.
  bool make_windows(GridPoint at, const WindowParts& parts, int radius, int probe,
                    std::array<ProbeWindows, 2>& windows) const {
    for (std::size_t k = 0; k < static_cast<std::size_t>(parts.count); ++k) {
      MomentWindow window;
      if (!make_window(input_.skeleton, at, parts.part[k], radius, window)) return false;
      windows[k].offset[probe] = static_cast<std::int32_t>(window.bytes - bytes_of(input_.skeleton));
      windows[k].shift[probe] = window.shift;
    }
    return true;
  }

  /// Adds the moments of windows about the pixels that lie `middle` columns from their own middles.
  void sum_windows(const ProbeWindows& windows, int middle, ProbeMoments& sums) const {
    if (middle == 0) {  // the only ones
      input_.kernels.probes.moments(windows, sums);
      return;
    }
    ProbeMoments m;
    input_.kernels.probes.moments(windows, m);
    for (int i = 0; i < probe_lanes; ++i) {
      add(moved({m.n[i], m.x[i], m.y[i], m.xx[i], m.xy[i], m.yy[i]}, middle), i, sums);
    }
  }

  static void add(const Moments& m, int i, ProbeMoments& sums) {
    sums.n[i] += m.n;
    sums.x[i] += m.x;
    sums.y[i] += m.y;
    sums.xx[i] += m.xx;
    sums.xy[i] += m.xy;
    sums.yy[i] += m.yy;
  }

  const LinePointInput& input_;
  ProbePicture picture_;
  ProbeView view_;
  int radius_;
};

/// Of what the loops read at once.
bool large_enough(const LinePointInput& input) { return input.luma.width >= 4 && input.luma.height >= 2; }

/// Takes skeleton pixels that are evenly spread, sixteen at a time.
class Spread {
 public:
  Spread(const LinePointInput& input, int spacing, BitView passed, StaticVector<LinePoint, max_line_points>& points,
         LinePointCounts& counts)
      : finder_(input),
        skeleton_(input.skeleton),
        spacing_(spacing),
        passed_(passed),
        points_(points),
        counts_(counts) {}

  void run() {
    for (int y = 0; y < skeleton_.height; ++y) {
      for (int word = 0; word < words_for(skeleton_.width); ++word) {
        BitWord ahead = ~BitWord{0};
        for (BitWord left = to_ask(y, word); left != 0; left = to_ask(y, word) & ahead) {
          const int bit = std::countr_zero(left);
          ahead = ~BitWord{1} << bit;
          ask(word * bits_per_word + bit, y);
        }
      }
    }
    look();
  }

 private:
  /// Pixels that are neither asked nor passed over.
  [[nodiscard]] BitWord to_ask(int y, int word) const { return skeleton_.row(y)[word] & ~passed_.row(y)[word]; }

  void ask(int x, int y) {
    probes_.x[probes_.count] = x;
    probes_.y[probes_.count] = y;
    pass(x, y, true);
    if (++probes_.count == probe_lanes) look();
  }

  /// Pixels from row y on that are too near for a point of their own.
  void pass(int x, int y, bool value) {
    const int first = std::max(x - spacing_ + 1, 0);
    const int last = std::min(x + spacing_ - 1, passed_.width - 1);
    const int end = std::min(y + spacing_, passed_.height);
    if (first / bits_per_word != last / bits_per_word) {
      for (int ny = y; ny < end; ++ny) set_span(passed_, ny, first, last, value);
      return;
    }
    const BitWord span = ~BitWord{0} >> (bits_per_word - 1 - (last - first)) << (first % bits_per_word);
    for (int ny = y; ny < end; ++ny) {
      BitWord& word = passed_.row(ny)[first / bits_per_word];
      word = value ? word | span : word & ~span;
    }
  }

  void look() {
    finder_.find(probes_);
    counts_.considered += probes_.count;
    for (int i = 0; i < probes_.count; ++i) {
      if (probes_.state[i] == probe_alive) {
        LinePoint point = finder_.point(probes_, i);
        point.length *= static_cast<float>(spacing_);
        points_.push_back(point);
      } else {  // beside a pixel without a point there may be one
        count_failed(probes_.state[i]);
        pass(probes_.x[i], probes_.y[i], false);
        passed_.set(probes_.x[i], probes_.y[i], true);
      }
    }
    for (int i = 0; i < probes_.count; ++i) {
      if (probes_.state[i] == probe_alive) pass(probes_.x[i], probes_.y[i], true);
    }
    probes_.count = 0;
  }

  void count_failed(ProbeState state) {
    if (state == probe_no_direction) ++counts_.no_direction;
    if (state == probe_no_edge) ++counts_.no_edge;
    if (state == probe_no_ground) ++counts_.no_ground;
    if (state == probe_wrong_width) ++counts_.wrong_width;
  }

  PointFinder finder_;
  ConstBitView skeleton_;
  int spacing_;
  BitView passed_;
  StaticVector<LinePoint, max_line_points>& points_;
  LinePointCounts& counts_;
  LineProbes probes_;
};

}  // namespace

void find_line_points_at(const LinePointInput& input, std::span<const WorkPoint> at, const WorkPoint& direction,
                         FoundLinePoints& points) {
  assert(at.size() <= probe_lanes);
  points.clear();
  const float length = math::hypot(direction.u, direction.v);
  const ConstBitView& mask = input.line_mask;
  if (!large_enough(input) || !(length > 0.0F)) return;
  LineProbes probes;
  for (const WorkPoint& p : at) {
    const bool inside =
        p.u >= 0.0F && p.v >= 0.0F && p.u < static_cast<float>(mask.width) && p.v < static_cast<float>(mask.height);
    if (!inside || !mask.get(static_cast<int>(p.u), static_cast<int>(p.v))) continue;
    const int i = probes.count++;
    probes.x[i] = static_cast<std::int32_t>(p.u);
    probes.y[i] = static_cast<std::int32_t>(p.v);
    probes.tangent_u[i] = direction.u / length;
    probes.tangent_v[i] = direction.v / length;
  }
  if (probes.count == 0) return;
  std::fill(probes.state + probes.count, probes.state + probe_lanes, probe_no_direction);
  const PointFinder finder(input);
  finder.find_along(probes);
  for (int i = 0; i < probes.count; ++i) {
    if (probes.state[i] == probe_alive) points.push_back(finder.point(probes, i));
  }
}

LinePointCounts find_line_points(const LinePointInput& input, BitView scratch,
                                 StaticVector<LinePoint, max_line_points>& points) {
  LinePointCounts counts;
  points.clear();
  if (!large_enough(input)) return counts;
  clear(scratch);
  // On a skeleton of n pixels every n / 512-th.
  const int spacing = count(input.skeleton) / static_cast<int>(max_line_points) + 1;
  Spread spread(input, spacing, scratch, points, counts);
  // Once more around pixels without a point. Of the thousands of pixels of clutter not all are asked.
  for (int round = 0; round < 2; ++round) spread.run();
  counts.dropped = static_cast<int>(points.dropped());
  return counts;
}

}  // namespace touchline
