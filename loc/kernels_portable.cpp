// SPDX-License-Identifier: Apache-2.0
#include "loc/kernel_loops.h"
#include "loc/noise_loops.h"
#include "vision/image/vector_registers.h"

namespace touchline {

LocKernels portable_loc_kernels() {
  if constexpr (!vector_registers) return scalar_loc_kernels();
  return {"portable", line_costs<Eight>, landmark_costs<Eight>, linearise<Eight>, sin_cos<Eight>, normals<Eight>};
}
LocKernels scalar_loc_kernels() {
  return {"scalar", line_costs<One>, landmark_costs<One>, linearise<One>, sin_cos<One>, normals<One>};
}

}  // namespace touchline
