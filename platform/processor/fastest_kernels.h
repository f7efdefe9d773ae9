// SPDX-License-Identifier: Apache-2.0
// Asks the processor which of the kernels' tables it can run. Outside the core, which asks nobody.
#pragma once

#include "vision/image/kernels.h"

namespace touchline {

inline Kernels fastest_kernels() {
#if defined(__x86_64__)
  if (avx2_kernels().name != nullptr && __builtin_cpu_supports("avx2")) return avx2_kernels();
#endif
  return portable_kernels();
}

}  // namespace touchline
