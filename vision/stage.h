// SPDX-License-Identifier: Apache-2.0
// The stages of the chain in the order of the data, and the observer that is told when each begins and ends.
#pragma once

#include <cstdint>

namespace touchline {

enum class Stage : std::uint8_t {
  average,      // subsample and mean of the FIFO (paper IV-A)
  green,        // HSV, min-max filter, erosion, dilation (IV-B)
  roi,          // largest blob, convex hull (IV-B)
  candidates,   // white search and Canny in the ROI (IV-C)
  line_mask,    // dilation, erosion (IV-C)
  thinning,     // Zhang-Suen (IV-C)
  digestion,    // major nodes (IV-D)
  graph,        // node graph (IV-E)
  junctions,    // X, T, L, centre circle (IV-E)
  posts,        // goal posts (VII)
  line_points,  // skeleton points on the ground, for the full model
  localize,     // feature manager and particle filter (V, VI)
  count,
};

/// Short name as used in the --json output, e.g. "line_mask".
const char* to_string(Stage stage);

/// Told by the chain; takes the time, counts instructions, or copies products. The chain itself reads no clock.
class StageObserver {
 public:
  void begin(Stage stage) { do_begin(stage); }
  void end(Stage stage) { do_end(stage); }

 protected:
  ~StageObserver() = default;

 private:
  virtual void do_begin(Stage stage) = 0;
  virtual void do_end(Stage stage) = 0;
};

/// Tells the observer, if there is one, when a stage begins and ends.
class StageScope {
 public:
  StageScope(StageObserver* observer, Stage stage) : observer_(observer), stage_(stage) {
    if (observer_ != nullptr) observer_->begin(stage_);
  }
  ~StageScope() {
    if (observer_ != nullptr) observer_->end(stage_);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  StageObserver* observer_;
  Stage stage_;
};

}  // namespace touchline
