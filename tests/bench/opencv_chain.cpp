// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/opencv_chain.h"

#include <opencv2/core/ocl.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc.hpp>

#include "tests/bench/cpu_clock.h"

namespace touchline::bench {
namespace {

cv::Mat square(int side) { return cv::getStructuringElement(cv::MORPH_RECT, {side, side}); }

}  // namespace

const char* to_string(PairedStage stage) {
  switch (stage) {
    case PairedStage::average: return "average";
    case PairedStage::green: return "green";
    case PairedStage::roi: return "roi";
    case PairedStage::candidates: return "candidates";
    case PairedStage::line_mask: return "line_mask";
    case PairedStage::thinning: return "thinning";
    case PairedStage::digestion: return "digestion";
    case PairedStage::count: break;
  }
  return "?";
}

void prepare_opencv() {
  cv::setNumThreads(1);
  cv::setUseOptimized(true);
  cv::ocl::setUseOpenCL(false);
}

double opencv_thinning(const cv::Mat& mask, cv::Mat& skeleton) {
  return timed([&] { cv::ximgproc::thinning(mask, skeleton, cv::ximgproc::THINNING_ZHANGSUEN); });
}

std::array<double, paired_stage_count> OpenCvChain::run(const std::vector<cv::Mat>& last_frames,
                                                        const GivenToOpenCv& given) {
  std::array<double, paired_stage_count> us{};
  std::size_t i = 0;
  us[i++] = timed([&] { average(last_frames); });
  us[i++] = timed([&] { find_green(given); });
  us[i++] = timed([&] { find_roi(given); });
  us[i++] = timed([&] { find_candidates(given); });
  us[i++] = timed([&] { make_line_mask(); });
  us[i++] = opencv_thinning(line_mask_, skeleton_);
  us[i++] = timed([&] { digest(); });
  return us;
}

/// The paper's order: mean of four frames, then resized (section IV-A).
void OpenCvChain::average(const std::vector<cv::Mat>& frames) {
  cv::add(frames[0], frames[1], sum_, cv::noArray(), CV_16U);
  cv::add(frames[2], frames[3], pair_, cv::noArray(), CV_16U);
  cv::add(sum_, pair_, sum_);
  sum_.convertTo(mean_frame_, CV_8U, 0.25);
  cv::resize(mean_frame_, mean_, size_, 0, 0, cv::INTER_AREA);
}

double OpenCvChain::average_of_small(const cv::Mat& newest) {
  return timed([&] {
    cv::resize(newest, small_[static_cast<std::size_t>(next_small_)], size_, 0, 0, cv::INTER_AREA);
    next_small_ = (next_small_ + 1) % 4;
    for (const cv::Mat& small : small_) {
      if (small.empty()) return;
    }
    cv::add(small_[0], small_[1], sum_, cv::noArray(), CV_16U);
    cv::add(small_[2], small_[3], pair_, cv::noArray(), CV_16U);
    cv::add(sum_, pair_, sum_);
    sum_.convertTo(mean_, CV_8U, 0.25);
  });
}

void OpenCvChain::find_green(const GivenToOpenCv& given) {
  cv::cvtColor(mean_, hsv_, cv::COLOR_RGB2HSV);
  const HsvRange& g = given.green;
  cv::inRange(hsv_, cv::Scalar(g.hue_low, g.saturation_low, g.value_low),
              cv::Scalar(g.hue_high, g.saturation_high, g.value_high), green_);
  cv::bitwise_and(green_, given.ground, green_);
  cv::erode(green_, green_, square(3));
  cv::dilate(green_, green_, square(5));
}

void OpenCvChain::find_roi(const GivenToOpenCv& given) {
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(green_, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  roi_ = cv::Mat::zeros(size_, CV_8U);
  double largest = 0.0;
  const std::vector<cv::Point>* field = nullptr;
  for (const auto& contour : contours) {
    const double area = cv::contourArea(contour);
    if (area > largest) {
      largest = area;
      field = &contour;
    }
  }
  if (field == nullptr) return;
  std::vector<cv::Point> hull;
  cv::convexHull(*field, hull);
  cv::fillConvexPoly(roi_, hull, cv::Scalar(255));
  cv::bitwise_and(roi_, given.ground, roi_);
}

void OpenCvChain::find_candidates(const GivenToOpenCv& given) {
  cv::cvtColor(mean_, gray_, cv::COLOR_RGB2GRAY);
  cv::GaussianBlur(gray_, gray_, {3, 3}, 0);
  cv::Canny(gray_, edges_, 40, 90);
  cv::inRange(hsv_, cv::Scalar(0, 0, given.white_value), cv::Scalar(179, given.white_saturation, 255), white_);
  // Of Canny's edges those that have white beside them (the paper's white search beside Canny).
  cv::dilate(white_, candidates_, square(3));
  cv::bitwise_and(edges_, candidates_, edges_);
  cv::bitwise_or(white_, edges_, candidates_);
  cv::bitwise_and(candidates_, roi_, candidates_);
}

void OpenCvChain::make_line_mask() {
  cv::dilate(candidates_, line_mask_, square(3));
  cv::erode(line_mask_, line_mask_, square(3));
}

/// Algorithm 1 in its matrix form, radius 5, weights 1, 10, 100.
void OpenCvChain::digest() {
  constexpr int radius = 5;
  cv::Mat bits;
  cv::threshold(skeleton_, bits, 0, 1, cv::THRESH_BINARY);
  cv::Mat neighbours;
  cv::boxFilter(bits, neighbours, CV_8U, {3, 3}, {-1, -1}, false, cv::BORDER_CONSTANT);
  weight_ = cv::Mat::zeros(size_, CV_32S);
  kind_ = cv::Mat::zeros(size_, CV_8U);
  std::vector<cv::Point> pixels;
  cv::findNonZero(bits, pixels);
  for (const cv::Point& p : pixels) {
    const int count = neighbours.at<std::uint8_t>(p) - 1;
    weight_.at<int>(p) = count <= 1 ? 0 : count == 2 ? 1 : count == 3 ? 10 : 100;
    kind_.at<std::uint8_t>(p) = 1;
  }
  for (const cv::Point& p : pixels) {
    int best = 0;
    int sum = 0;
    cv::Point at;
    for (int pass = 0; pass < 2; ++pass) {
      for (int y = std::max(p.y - radius, 0); y <= std::min(p.y + radius, size_.height - 1); ++y) {
        int* weights = weight_.ptr<int>(y);
        std::uint8_t* kinds = kind_.ptr<std::uint8_t>(y);
        for (int x = std::max(p.x - radius, 0); x <= std::min(p.x + radius, size_.width - 1); ++x) {
          if (kinds[x] == 0 || (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y) > radius * radius) continue;
          if (pass == 0) {
            sum += weights[x];
            if (weights[x] > best) {
              best = weights[x];
              at = {x, y};
            }
          } else if (x != at.x || y != at.y) {
            weights[x] = 0;
            kinds[x] = 1;
          }
        }
      }
      if (best == 0) break;
    }
    if (best == 0) continue;
    weight_.at<int>(at) = sum;
    kind_.at<std::uint8_t>(at) = 2;
  }
  major_nodes_ = cv::countNonZero(kind_ == 2);
}

}  // namespace touchline::bench
