// SPDX-License-Identifier: Apache-2.0
// Precision and recall of the reported junctions against the data set's expected/NNN.json.
//
// A landmark X, T or L within 2.5 m that nothing hides is to be found: a junction of its type within 4 camera pixels of
// it. A reported junction within 2.5 m (by its own ground point) is right when such a landmark of its type, at whatever
// range, is within 4 camera pixels; neutral when only hidden ones are; otherwise false.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "vision/features.h"

namespace touchline::host {

inline constexpr float junction_range_m = 2.5F;
inline constexpr float junction_radius_px = 4.0F;

struct ExpectedLandmark {
  JunctionType type = JunctionType::l;
  PixelPoint pixel;
  float range_m = 0.0F;
  bool occluded = false;
};

/// The X, T and L of expected/<stem of image>.json beside the folder of `image`; nothing when there is no such file.
/// Throws HostError when the file is broken.
std::optional<std::vector<ExpectedLandmark>> read_expected(const std::filesystem::path& image);

struct JunctionCount {
  int to_find = 0;
  int found = 0;
  int right = 0;
  int wrong = 0;

  [[nodiscard]] double recall() const { return to_find > 0 ? static_cast<double>(found) / to_find : 1.0; }
  [[nodiscard]] double precision() const {
    return right + wrong > 0 ? static_cast<double>(right) / (right + wrong) : 1.0;
  }
  JunctionCount& operator+=(const JunctionCount& other);
};
using JunctionScore = std::array<JunctionCount, 3>;  // by JunctionType
JunctionScore& operator+=(JunctionScore& sum, const JunctionScore& other);

JunctionScore score_junctions(std::span<const ExpectedLandmark> expected, std::span<const Junction> reported);

}  // namespace touchline::host
