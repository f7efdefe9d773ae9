// SPDX-License-Identifier: Apache-2.0
// Asks the processor which of the kernels' tables it can run. Outside the core, which asks nobody.
#pragma once

#include "loc/kernels.h"
#include "vision/image/kernels.h"

namespace touchline {

inline Kernels fastest_kernels() {
#if defined(__x86_64__)
  // The processor first: the function that names them is compiled for AVX2 itself.
  if (__builtin_cpu_supports("avx2") && avx2_kernels().name != nullptr) return avx2_kernels();
#endif
  return portable_kernels();
}

inline LocKernels fastest_loc_kernels() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && avx2_loc_kernels().name != nullptr) return avx2_loc_kernels();
#endif
  return portable_loc_kernels();
}

}  // namespace touchline
