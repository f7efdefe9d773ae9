// SPDX-License-Identifier: Apache-2.0
// One number for each product of the chain, for the golden outputs. Hashed value by value, so that neither padding nor
// stride nor the machine's byte order has a say; floats by their bits, as a pose has to be the same bit for bit.
#pragma once

#include <cstdint>

#include "loc/localizer.h"
#include "platform/core/static_vector.h"
#include "vision/vision_result.h"

namespace touchline::test {

struct ProductHash {
  const char* name = nullptr;
  std::uint64_t hash = 0;
};
using ProductHashes = StaticVector<ProductHash, 20>;  // 16 products today

/// In the order of the data, from the mean frame to the line points.
ProductHashes hash_products(const VisionResult& result);
std::uint64_t hash_estimate(const PoseEstimate& estimate);

}  // namespace touchline::test
