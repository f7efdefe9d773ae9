// SPDX-License-Identifier: Apache-2.0
// Google Benchmark's part: how the cost grows, and the worst frames.
#pragma once

#include "tests/bench/bench_frames.h"
#include "tests/bench/kernel_choice.h"

namespace touchline::bench {

/// Registers everything; `pool` outlives the runs.
void register_scaling(const FramePool& pool, const KernelChoice& kernels);

}  // namespace touchline::bench
