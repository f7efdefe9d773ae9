// SPDX-License-Identifier: Apache-2.0
// Runs a data set through the chain by its protocol and judges every pose.
//
// independent: each frame is a start from nothing. It is shown to the filter again until the filter says that it has
// settled, at most 48 times (a second of camera). Vision sees it once: the mean of equal frames is that frame.
// sequence: one run through all frames, one update each.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "loc/known_junctions.h"
#include "platform/host/chain.h"
#include "platform/host/dataset.h"
#include "platform/host/junction_score.h"
#include "platform/host/pose_error.h"
#include "platform/host/stage_clock.h"

namespace touchline::host {

inline constexpr int max_shows = 48;
inline constexpr double default_frame_s = 1.0 / 48.0;  // between frames that carry no time: the paper's camera

struct EvaluateOptions {
  ChainOptions chain;
  std::uint64_t seed = 1;
  bool use_yaw = true;
  std::string frames_out;  // folder for annotated pictures; empty: none
};

struct FrameRecord {
  DataFrame frame;
  std::string failure;  // why the frame could not be used; then all below is void
  PoseEstimate estimate;
  int shows = 0;
  bool settled = false;
  std::vector<KnownJunction> junctions;
  int junctions_turned_down = 0;  // by a sure pose
  std::vector<PostObservation> posts;
  StageTimes us{};
  std::optional<PoseError> error;  // where there is a truth
  // Where there are expected landmarks: of what vision reports, and of `junctions`.
  std::optional<JunctionScore> seen_junction_score;
  std::optional<JunctionScore> junction_score;
};

struct SetResult {
  std::string name;
  Protocol protocol = Protocol::independent;
  std::vector<FrameRecord> frames;
  std::optional<SequenceScore> sequence;  // sequences with truth
};

/// A frame that cannot be used is recorded with its failure, and the run goes on; in a sequence its odometry is added
/// to the next frame's. Throws HostError for what concerns all frames. `on_frame` is told each record as it is made.
SetResult evaluate(const DataSet& set, const EvaluateOptions& options,
                   const std::function<void(const FrameRecord&)>& on_frame = {});

/// The folder below --frames for a set's pictures: its name, as far as a folder can have it.
std::string folder_name(const std::string& set_name);

/// The figures of some frames together.
struct Summary {
  int frames = 0;
  int failed = 0;  // could not be used; all below is about the others
  int with_pose = 0;
  int with_truth = 0;
  int without_pose = 0;  // of those with truth: failures
  int wrong_half = 0;
  int outside_3_sigma = 0;
  /// Of the frames with truth; a failure counts as infinitely far.
  std::vector<double> distances_m;
  std::vector<double> angles_deg;
  bool has_junctions = false;
  JunctionScore seen_junctions{};  // vision alone
  JunctionScore junctions{};       // as reported: checked with the map
  double mean_shows = 0.0;
  int most_shows = 0;
  int not_settled = 0;
  StageTimes median_us{};

  [[nodiscard]] int within(double metres) const;
  [[nodiscard]] int within(double metres, double degrees) const;
  [[nodiscard]] double median_m() const { return quantile(distances_m, 0.5); }
  [[nodiscard]] double median_deg() const { return quantile(angles_deg, 0.5); }
  [[nodiscard]] double worst_m() const { return quantile(distances_m, 1.0); }
};
Summary summarize(std::span<const FrameRecord* const> frames);
Summary summarize(const SetResult& set);

}  // namespace touchline::host
