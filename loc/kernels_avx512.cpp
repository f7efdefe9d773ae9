// SPDX-License-Identifier: Apache-2.0
// Kernels for x86-64 with AVX-512: F, BW, DQ, VL, VBMI and VNNI. Of localization this file alone is compiled for it, as
// kernels_avx2.cpp is for AVX2. Sixteen poses have a register; what has eight for its order gains by twice as many
// registers.
#include "loc/kernels.h"

#if defined(__x86_64__) && defined(__AVX512F__) && defined(__AVX512BW__) && defined(__AVX512DQ__) && \
    defined(__AVX512VL__) && defined(__AVX512VBMI__) && defined(__AVX512VNNI__)
// Without optimisation g++'s gathers are macros, whose conversions are warned of where they are used.
#pragma GCC diagnostic ignored "-Wsign-conversion"
#include "loc/kernel_loops.h"
#include "loc/noise_loops.h"

namespace touchline {
LocKernels avx512_loc_kernels() {
  return {"avx512", line_costs<Sixteen>, landmark_costs<Sixteen>, linearise<Eight>, sin_cos<Sixteen>, normals<Eight>};
}
}  // namespace touchline

#else

namespace touchline {
LocKernels avx512_loc_kernels() { return {}; }
}  // namespace touchline

#endif
