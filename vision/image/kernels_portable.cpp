// SPDX-License-Identifier: Apache-2.0
#include "vision/image/kernels.h"
#include "vision/image/ridge_block_loops.h"

namespace touchline {

Kernels portable_kernels() { return {"portable", nullptr, ridge::find_ridges}; }

}  // namespace touchline
