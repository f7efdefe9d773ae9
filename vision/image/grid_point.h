// SPDX-License-Identifier: Apache-2.0
// A pixel by its indices.
#pragma once

#include <cstdint>

namespace touchline {

struct GridPoint {  // a working pixel
  std::int16_t x = 0;
  std::int16_t y = 0;
  bool operator==(const GridPoint&) const = default;
};

}  // namespace touchline
