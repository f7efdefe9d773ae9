// SPDX-License-Identifier: Apache-2.0
// Everything the chain made of one frame, by reference into the pipeline's storage: valid until the next frame.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "vision/candidates.h"
#include "vision/features.h"
#include "vision/graph.h"
#include "vision/image/bit_image.h"
#include "vision/image/image_view.h"
#include "vision/lens/camera_pose.h"
#include "vision/line_width_table.h"

namespace touchline {

struct VisionCounts {
  int frames_in_mean = 0;   // 1..depth
  int frames_left_out = 0;  // held in the FIFO, but moved by more than about a working pixel
  int green_pixels = 0;
  int roi_pixels = 0;
  int candidate_pixels = 0;
  int line_pixels = 0;
  int skeleton_pixels = 0;
  int major_nodes = 0;
  std::array<int, candidate_rejections> rejected_candidates{};  // by CandidateRejection
  // What found no room; the partial result is valid.
  int dropped_blobs = 0;
  int dropped_edge_seeds = 0;  // hystereses, of ridges and of Canny's edges, that reached their bound of sweeps
  int dropped_nodes = 0;
  int dropped_edges = 0;
  int dropped_points = 0;  // of the skeleton, and short pieces too long for the memory to be taken away whole
  int dropped_junctions = 0;
  int dropped_posts = 0;
  int dropped_line_points = 0;

  /// All that found no room.
  [[nodiscard]] constexpr int dropped() const {
    return dropped_blobs + dropped_edge_seeds + dropped_nodes + dropped_edges + dropped_points + dropped_junctions +
           dropped_posts + dropped_line_points;
  }
};

struct VisionResult {
  double time_s = 0.0;          // of the newest frame; the mean holds only frames of its attitude
  GroundProjection projection;  // lens and attitude that the features were measured with
  int frame_width = 0;          // camera pixels
  int frame_height = 0;
  int work_width = 0;
  int work_height = 0;
  ConstYuv420View mean;             // working size
  ConstBitView green;               // after erosion and dilation
  ConstBitView field;               // the largest blob
  std::span<const GridPoint> hull;  // of the largest blob
  ConstBitView roi;
  ConstBitView edges;       // Canny's, near white that white search left open
  ConstBitView candidates;  // white search united with Canny
  ConstBitView line_mask;
  ConstBitView skeleton;
  LineWidthView line_widths;
  std::span<const MajorNode> major_nodes;
  NodeGraphView graph;
  const Features* features = nullptr;  // never null after a successful call
  VisionCounts counts;
};

}  // namespace touchline
