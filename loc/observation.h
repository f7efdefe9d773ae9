// SPDX-License-Identifier: Apache-2.0
// What one frame says about the pose, in the form that the likelihood and the refinement need. Data and its making.
#pragma once

#include <array>
#include <cassert>

#include "platform/core/geometry.h"
#include "vision/vision_result.h"

namespace touchline {

struct LocalizerConfig;

/// A point on a line, with what it is worth.
struct LineSample {
  GroundPoint ground;  // with the attitude as given
  float dir_x = 1.0F;  // unit direction of the line on the ground, robot's frame
  float dir_y = 0.0F;
  float own_variance = 0.0F;  // square metres across the line: pixel and floor, not the tilt
  float variance = 0.0F;      // likewise, with what one sigma of pitch and roll make
  float weight = 1.0F;        // independent measurements that it stands for; neighbours on one line share their errors
};

/// `count` samples in columns, in somebody else's memory, with room for a multiple of eight.
struct LineSampleView {
  const float *ground_x = nullptr, *ground_y = nullptr;
  const float *dir_x = nullptr, *dir_y = nullptr;
  const float* own_variance = nullptr;
  const float* weight = nullptr;
  int count = 0;
};

/// Samples as a structure of arrays, so that one loop runs over one quantity of eight samples at a time.
template <std::size_t N>
class LineSamples {
  static_assert(N % 8 == 0, "loops take eight samples at a time");

 public:
  void clear() { size_ = 0; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  /// False when full.
  bool push_back(const LineSample& s) {
    if (size_ == N) return false;
    set(size_++, s);
    return true;
  }
  void set(std::size_t i, const LineSample& s) {
    assert(i < size_);
    const float row[columns] = {s.ground.x, s.ground.y, s.dir_x, s.dir_y, s.own_variance, s.variance, s.weight};
    for (std::size_t k = 0; k < columns; ++k) values_[k][i] = row[k];
  }
  [[nodiscard]] LineSample operator[](std::size_t i) const {
    assert(i < size_);
    const auto at = [&](std::size_t k) { return values_[k][i]; };
    return {{at(0), at(1)}, at(2), at(3), at(4), at(5), at(6)};
  }
  [[nodiscard]] LineSampleView view() const {
    const auto column = [&](std::size_t k) { return values_[k].data(); };
    return {column(0), column(1), column(2), column(3), column(4), column(6), static_cast<int>(size_)};
  }

 private:
  static constexpr std::size_t columns = 7;
  std::array<std::array<float, N>, columns> values_{};
  std::size_t size_ = 0;
};

inline constexpr std::size_t max_line_samples = 512;
inline constexpr std::size_t max_filter_samples = 96;  // enough for 200 particles to tell poses apart; the rest refines

struct Observation {
  LineSamples<max_line_samples> lines;
  LineSamples<max_filter_samples> filter_lines;  // evenly spread part of `lines`, weights summed up
  float line_weight = 0.0F;                      // sum of the weights of filter_lines
  CameraPose camera;
  const Features* features = nullptr;
};

/// Line points become samples when `config` lets lines be used. Length of line per independent measurement: a line's
/// points share calibration and paint errors, so that a metre of line is worth about seven measurements, not fifty.
inline constexpr float metres_per_measurement = 0.15F;

void make_observation(const VisionResult& vision, const LocalizerConfig& config, Observation& out);

}  // namespace touchline
