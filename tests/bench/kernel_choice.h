// SPDX-License-Identifier: Apache-2.0
// The kernels that all rows of a run take: the fastest, or those of one name, so that the figures of a lesser processor
// can be had on a better one.
#pragma once

#include <string>

#include "platform/processor/fastest_kernels.h"

namespace touchline::bench {

struct KernelChoice {
  Kernels vision = fastest_kernels();
  LocKernels localization = fastest_loc_kernels();
};

/// Both tables of a name, as "avx2"; "words" comes with localization's "scalar", for they are what processors without
/// vector registers take. Throws std::runtime_error, with the names that this processor runs, for any other.
KernelChoice kernels_named(const std::string& name);

/// "portable, words or avx2": what this processor runs.
std::string kernel_names();

}  // namespace touchline::bench
