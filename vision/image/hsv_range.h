// SPDX-License-Identifier: Apache-2.0
// A range of colours in hue, saturation and value (paper section IV-B).
#pragma once

#include <cstdint>

namespace touchline {

/// HSV ranges: hue 0..179 (2 degrees a step, the convention of teams' colour files), saturation and value 0..255. All
/// bounds are inside. hue_low > hue_high means the range over zero: hue_low..179 and 0..hue_high.
struct HsvRange {
  std::uint8_t hue_low = 0, hue_high = 179;
  std::uint8_t saturation_low = 0, saturation_high = 255;
  std::uint8_t value_low = 0, value_high = 255;
  bool operator==(const HsvRange&) const = default;
};

}  // namespace touchline
