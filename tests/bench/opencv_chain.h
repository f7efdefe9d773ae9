// SPDX-License-Identifier: Apache-2.0
// The paper's vision steps as a good user of OpenCV 4.6 would write them: the other side of the benchmark.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

#include "vision/image/hsv.h"

namespace touchline::bench {

/// What our chain measures or knows by geometry, and OpenCV's steps are given for nothing: the carpet's colour in this
/// light, and where ground can be seen at all.
struct GivenToOpenCv {
  HsvRange green;
  int white_saturation = 0;  // less than this
  int white_value = 0;       // more than this
  cv::Mat ground;            // 0 or 255, working size
};

/// The steps that both sides share, in order.
enum class PairedStage : std::uint8_t { average, green, roi, candidates, line_mask, thinning, digestion, count };
inline constexpr std::size_t paired_stage_count = static_cast<std::size_t>(PairedStage::count);
const char* to_string(PairedStage stage);

class OpenCvChain {
 public:
  OpenCvChain(int width, int height) : size_(width, height) {}

  /// Times of every stage in microseconds; the products stay until the next call.
  std::array<double, paired_stage_count> run(const std::vector<cv::Mat>& last_frames, const GivenToOpenCv& given);
  /// The kinder way to average: every frame is resized once, when it comes, and small frames are averaged.
  double average_of_small(const cv::Mat& newest);

  [[nodiscard]] const cv::Mat& roi() const { return roi_; }
  [[nodiscard]] const cv::Mat& green() const { return green_; }
  [[nodiscard]] const cv::Mat& line_mask() const { return line_mask_; }
  [[nodiscard]] const cv::Mat& skeleton() const { return skeleton_; }
  [[nodiscard]] int major_nodes() const { return major_nodes_; }

 private:
  void average(const std::vector<cv::Mat>& frames);
  void find_green(const GivenToOpenCv& given);
  void find_roi(const GivenToOpenCv& given);
  void find_candidates(const GivenToOpenCv& given);
  void make_line_mask();
  void digest();

  cv::Size size_;
  cv::Mat mean_, sum_, pair_, mean_frame_, hsv_, green_, roi_, gray_, edges_, white_, candidates_, line_mask_,
      skeleton_, weight_, kind_;
  std::array<cv::Mat, 4> small_;
  int next_small_ = 0;
  int major_nodes_ = 0;
};

/// One thread, the processor's own vectors, no graphics card.
void prepare_opencv();

/// Zhang-Suen by OpenCV contrib, for the comparison on one and the same mask. Microseconds.
double opencv_thinning(const cv::Mat& mask, cv::Mat& skeleton);

}  // namespace touchline::bench
