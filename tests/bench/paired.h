// SPDX-License-Identifier: Apache-2.0
// Our stages and OpenCV's on the same frames, in turn, and the yardstick in the same run.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/bench_frames.h"
#include "tests/bench/kernel_choice.h"
#include "tests/bench/report.h"

namespace touchline::bench {

struct PairedResult {
  std::vector<PairedRow> rows;  // stage by stage, then fused groups, then "vision"
  std::vector<AgreementRow> agreement;
  Spread memcpy_us;
  Spread frame_to_pose_us;        // tracking
  Spread frame_to_first_pose_us;  // from nothing: the search over the whole field included
  Spread localize_us;             // tracking, on the frames
  Spread features_us;             // graph, junctions and posts
  double line_agreement = 0.0;    // IoU of the line masks, median
  Spread line_points_us;          // of ours alone: no part of the paper's chain
  std::vector<int> dropped;       // per view, of all capacities
};

/// `rounds` times through all views of the pool.
PairedResult run_paired(const FramePool& pool, int rounds, const KernelChoice& kernels);

}  // namespace touchline::bench
