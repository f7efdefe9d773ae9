// SPDX-License-Identifier: Apache-2.0
// Memory for one thinning, with something in it that does not matter.
#pragma once

#include <vector>

#include "vision/image/thinning.h"

namespace touchline::test {

struct OwnThinningMemory {
  std::vector<BitWord> columns, deleted, marks;
  OwnThinningMemory(int width, int height)
      : columns(thinning_columns_size(width, height), 0xDEADBEEFDEADBEEFU),
        deleted(thinning_deleted_size(width, height), 0xDEADBEEFDEADBEEFU),
        marks(thinning_marks_size(width, height), 0xDEADBEEFDEADBEEFU) {}
  [[nodiscard]] ThinningMemory memory() { return {columns, deleted, marks}; }
};

}  // namespace touchline::test
