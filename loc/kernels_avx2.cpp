// SPDX-License-Identifier: Apache-2.0
// Kernels for x86-64 with AVX2. This file alone of localization is compiled for it: nothing here may be inlined
// elsewhere, and no inline function of a header may be called, or the linker could hand its copy to those that run on
// older processors.
#include "loc/kernels.h"

#if defined(__x86_64__) && defined(__AVX2__)
#include "loc/kernel_loops.h"
#include "loc/noise_loops.h"

namespace touchline {
LocKernels avx2_loc_kernels() {
  return {"avx2", line_costs<Eight>, landmark_costs<Eight>, linearise<Eight>, sin_cos<Eight>, normals<Eight>};
}
}  // namespace touchline

#else

namespace touchline {
LocKernels avx2_loc_kernels() { return {}; }
}  // namespace touchline

#endif
