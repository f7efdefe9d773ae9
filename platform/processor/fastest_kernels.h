// SPDX-License-Identifier: Apache-2.0
// Asks the processor which of the kernels' tables it can run. Outside the core, which asks nobody.
#pragma once

#include "loc/kernels.h"
#include "vision/image/kernels.h"

namespace touchline {

#if defined(__x86_64__)
/// The processor and the operating system, which has to save the registers.
inline bool runs_avx2() { return __builtin_cpu_supports("avx2") != 0; }
inline bool runs_avx512() {
  return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
         __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512vbmi") != 0 && __builtin_cpu_supports("avx512vbmi2") != 0 &&
         __builtin_cpu_supports("avx512vnni") != 0;
}
#endif

/// A table for this processor: 0 is the portable one, higher ones are faster; without a name where there is none.
inline constexpr int kernel_tables = 3;
inline Kernels kernel_table(int i) {
  if (i == 0) return portable_kernels();
#if defined(__x86_64__)
  // The processor first: the function that names them is compiled for its instructions itself.
  if (i == 1 && runs_avx2()) return avx2_kernels();
  if (i == 2 && runs_avx512()) return avx512_kernels();
#endif
  return {};
}

inline Kernels fastest_kernels() {
  for (int i = kernel_tables - 1; i > 0; --i) {
    const Kernels kernels = kernel_table(i);
    if (kernels.name != nullptr) return kernels;
  }
  return portable_kernels();
}

inline LocKernels loc_kernel_table(int i) {
  if (i == 0) return portable_loc_kernels();
#if defined(__x86_64__)
  if (i == 1 && runs_avx2()) return avx2_loc_kernels();
  if (i == 2 && runs_avx512()) return avx512_loc_kernels();
#endif
  return {};
}

inline LocKernels fastest_loc_kernels() {
  for (int i = kernel_tables - 1; i > 0; --i) {
    const LocKernels kernels = loc_kernel_table(i);
    if (kernels.name != nullptr) return kernels;
  }
  return portable_loc_kernels();
}

}  // namespace touchline
