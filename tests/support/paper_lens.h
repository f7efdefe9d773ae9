// SPDX-License-Identifier: Apache-2.0
// The lens of the paper's robot: 185 degrees, equidistant, 752x480.
#pragma once

#include <doctest/doctest.h>

#include "vision/lens/lens.h"

namespace touchline::test {

inline Lens paper_lens() {
  LensParameters p;
  p.model = LensModel::equidistant;
  p.focal_px = 232.9F;
  p.cx = 376.0F;
  p.cy = 240.0F;
  p.max_theta = radians(92.5F);
  Lens lens;
  REQUIRE(Lens::create(p, lens) == Status::ok);
  return lens;
}

}  // namespace touchline::test
