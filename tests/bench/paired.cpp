// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/paired.h"

#include <cstring>
#include <memory>

#include <opencv2/imgproc.hpp>

#include "tests/bench/chain_under_test.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/opencv_chain.h"
#include "tests/support/thinning_memory.h"
#include "vision/green.h"
#include "vision/ground_mask.h"
#include "vision/image/bit_ops.h"
#include "vision/image/thinning.h"

namespace touchline::bench {
namespace {

using Samples = std::vector<double>;
constexpr int width = 320;
constexpr int height = 240;

cv::Mat to_mat(const ConstBitView& mask) {
  cv::Mat mat = cv::Mat::zeros(mask.height, mask.width, CV_8U);
  for_each_set_bit(mask, [&](int x, int y) { mat.at<std::uint8_t>(y, x) = 255; });
  return mat;
}

double overlap(const cv::Mat& a, const cv::Mat& b) {
  const int either = cv::countNonZero(a | b);
  return either == 0 ? 1.0 : static_cast<double>(cv::countNonZero(a & b)) / either;
}

/// Share of the pixels of `a` that have one of `b` within a pixel.
double covered(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat wide;
  cv::dilate(b, wide, cv::Mat());
  const int all = cv::countNonZero(a);
  return all == 0 ? 1.0 : static_cast<double>(cv::countNonZero(a & wide)) / all;
}

struct StageGroup {
  const char* name;
  std::vector<Stage> ours;
  std::vector<PairedStage> opencv;
  const char* note;
};
/// Stages that we fuse are compared as a group: our white search works with the green stage's white mask and width
/// table, and our edges are part of the search.
const std::vector<StageGroup>& groups() {
  static const std::vector<StageGroup> all = {
      {"average", {Stage::average}, {PairedStage::average}, "mean of 4 frames, subsampled to 320x240"},
      {"green", {Stage::green}, {PairedStage::green}, "ours: horizon, line widths, carpet's colour and white mask too"},
      {"roi", {Stage::roi}, {PairedStage::roi}, ""},
      {"candidates", {Stage::candidates}, {PairedStage::candidates}, ""},
      {"line_mask", {Stage::line_mask}, {PairedStage::line_mask}, "ours: growing and trimming of lines too"},
      {"candidates+line_mask",
       {Stage::candidates, Stage::line_mask},
       {PairedStage::candidates, PairedStage::line_mask},
       "group"},
      {"green..line_mask",
       {Stage::green, Stage::roi, Stage::candidates, Stage::line_mask},
       {PairedStage::green, PairedStage::roi, PairedStage::candidates, PairedStage::line_mask},
       "group: from the mean to the line mask"},
      {"thinning", {Stage::thinning}, {PairedStage::thinning}, "ours: short pieces removed too"},
      {"digestion", {Stage::digestion}, {PairedStage::digestion}, "OpenCV has none: plain loops over its matrices"},
      {"average..digestion",
       {Stage::average, Stage::green, Stage::roi, Stage::candidates, Stage::line_mask, Stage::thinning,
        Stage::digestion},
       {PairedStage::average, PairedStage::green, PairedStage::roi, PairedStage::candidates, PairedStage::line_mask,
        PairedStage::thinning, PairedStage::digestion},
       "group: the steps that both sides have, from the frame to the major nodes"},
  };
  return all;
}

class PairedRun {
 public:
  PairedRun(const FramePool& pool, const KernelChoice& kernels)
      : pool_(pool), chain_(std::make_unique<ChainUnderTest<>>(kernels)), opencv_(width, height) {
    chain_->configure(pool);
    Lens lens;
    require(Lens::create(pool.lens, lens), "lens");
    rays_.resize(static_cast<std::size_t>(ray_columns(width) * ray_rows(height)));
    grid_ = {rays_, ray_columns(width), ray_rows(height)};
    make_ray_grid(lens, pool.width, pool.height, width, height, grid_);
    make_seen_mask(lens, pool.width, pool.height, {}, seen_.view());
    target_.resize(static_cast<std::size_t>(pool.width * pool.height * 3));
  }

  /// Both sides on the last shot of a view; the one before first in turn.
  void run_view(std::size_t index, bool ours_first) {
    const View& view = pool_.views[index];
    warm_up(view);
    std::vector<cv::Mat> frames;
    for (const auto& shot : view.shots) {
      frames.emplace_back(pool_.height, pool_.width, CV_8UC3, const_cast<std::uint8_t*>(shot.data()));
    }
    const GivenToOpenCv given = what_opencv_is_given(view);
    std::array<double, paired_stage_count> theirs{};
    if (!ours_first) theirs = opencv_.run(frames, given);
    run_ours(view);
    if (ours_first) theirs = opencv_.run(frames, given);
    keep(theirs);
    for (const cv::Mat& frame : frames) kinder_us_ = opencv_.average_of_small(frame);
    result_kinder_.push_back(kinder_us_);
    ours_average_.push_back(ours_[static_cast<std::size_t>(Stage::average)]);
    copy_yardstick(pool_.views[(index + pool_.views.size() / 2) % pool_.views.size()]);
    compare_products();
    result_.dropped.push_back(chain_->vision.counts.dropped());
  }

  /// The search for the first pose, on a single shot.
  void first_pose(const View& view) {
    chain_->pipeline.reset();
    (void)chain_->localizer.reset(Prior{}, 1);
    first_pose_.push_back(timed([&] {
      chain_->see(pool_.frame(view, 0), view.mount, 0.0);
      (void)chain_->locate(view, 0.0);
    }));
  }

  PairedResult finish() {
    for (std::size_t g = 0; g < groups().size(); ++g) {
      result_.rows.push_back(paired_row(groups()[g].name, group_ours_[g], group_opencv_[g], groups()[g].note));
    }
    result_.rows.push_back(paired_row("average, OpenCV resizing first", ours_average_, result_kinder_,
                                      "OpenCV keeps small frames, against the paper's order"));
    result_.rows.push_back(
        paired_row("thinning, same mask", same_mask_ours_, same_mask_opencv_, "both on our line mask"));
    result_.rows.push_back(
        paired_row("vision", vision_ours_, vision_opencv_, "frame to junctions; OpenCV ends at the major nodes"));
    result_.agreement = {{"green after erosion and dilation", spread_of(iou_green_), "IoU"},
                         {"ROI", spread_of(iou_roi_), "IoU"},
                         {"line mask", spread_of(iou_lines_), "IoU"},
                         {"line mask, ours", spread_of(lines_covered_), "share within a pixel of OpenCV's"},
                         {"skeleton", spread_of(iou_skeleton_), "IoU"},
                         {"skeleton, ours", spread_of(skeleton_covered_), "share within a pixel of OpenCV's"},
                         {"skeleton of the same mask", spread_of(iou_same_mask_), "IoU"}};
    result_.memcpy_us = spread_of(memcpy_);
    result_.frame_to_pose_us = spread_of(frame_to_pose_);
    result_.frame_to_first_pose_us = spread_of(first_pose_);
    result_.localize_us = spread_of(localize_);
    result_.line_points_us = spread_of(line_points_);
    result_.features_us = spread_of(features_);
    result_.line_agreement = spread_of(iou_lines_).median;
    return result_;
  }

 private:
  void warm_up(const View& view) {
    chain_->pipeline.reset();
    chain_->expect_near(view.truth);
    for (int shot = 0; shot + 1 < shots_per_view; ++shot) {
      chain_->see(pool_.frame(view, shot), view.mount, 0.02 * shot);
      (void)chain_->locate(view, 0.02 * shot);
    }
    if (chain_->vision.counts.frames_in_mean != shots_per_view - 1)
      throw std::runtime_error("the FIFO left frames out");
  }

  GivenToOpenCv what_opencv_is_given(const View& view) {
    const VisionConfig& config = chain_->pipeline.config();
    make_ground_mask(grid_, view.mount, config.max_range_m, seen_.view(), ground_.view());
    const CarpetModel carpet = measure_carpet(chain_->vision.mean, ground_.view(), config.green, scratch_mask_.view());
    GivenToOpenCv given;
    given.green = carpet.green;
    given.white_saturation = std::max(carpet.green.saturation_low - 1, 0);
    given.white_value = std::min(carpet.shadow_luma + 40, 250);
    given.ground = to_mat(ground_.view());
    return given;
  }

  void run_ours(const View& view) {
    CpuStageClock clock;
    chain_->see(pool_.frame(view, shots_per_view - 1), view.mount, 0.06, &clock);
    localize_us_ = timed([&] { (void)chain_->locate(view, 0.06); });
    ours_ = clock.times();
  }

  void keep(const std::array<double, paired_stage_count>& theirs) {
    for (std::size_t g = 0; g < groups().size(); ++g) {
      double ours_us = 0.0;
      double opencv_us = 0.0;
      for (const Stage s : groups()[g].ours) ours_us += ours_[static_cast<std::size_t>(s)];
      for (const PairedStage s : groups()[g].opencv) opencv_us += theirs[static_cast<std::size_t>(s)];
      group_ours_[g].push_back(ours_us);
      group_opencv_[g].push_back(opencv_us);
    }
    double vision = 0.0;
    for (std::size_t s = 0; s <= static_cast<std::size_t>(Stage::junctions); ++s) vision += ours_[s];
    vision_ours_.push_back(vision);
    double opencv = 0.0;
    for (const double us : theirs) opencv += us;
    vision_opencv_.push_back(opencv);
    features_.push_back(ours_[static_cast<std::size_t>(Stage::graph)] +
                        ours_[static_cast<std::size_t>(Stage::junctions)] +
                        ours_[static_cast<std::size_t>(Stage::posts)]);
    const double points = ours_[static_cast<std::size_t>(Stage::line_points)];
    line_points_.push_back(points);
    localize_.push_back(localize_us_);
    frame_to_pose_.push_back(vision + ours_[static_cast<std::size_t>(Stage::posts)] + points + localize_us_);
  }

  void copy_yardstick(const View& view) {
    const auto& shot = view.shots[1];
    memcpy_.push_back(timed([&] {
      std::memcpy(target_.data(), shot.data(), target_.size());
      asm volatile("" : : "r"(target_.data()) : "memory");
    }));
  }

  void compare_products() {
    const VisionResult& v = chain_->vision;
    const cv::Mat lines = to_mat(v.line_mask);
    const cv::Mat skeleton = to_mat(v.skeleton);
    iou_green_.push_back(overlap(to_mat(v.green), opencv_.green()));
    iou_roi_.push_back(overlap(to_mat(v.roi), opencv_.roi()));
    iou_lines_.push_back(overlap(lines, opencv_.line_mask()));
    lines_covered_.push_back(covered(lines, opencv_.line_mask()));
    iou_skeleton_.push_back(overlap(skeleton, opencv_.skeleton()));
    skeleton_covered_.push_back(covered(skeleton, opencv_.skeleton()));
    copy(v.line_mask, thinned_.view());
    same_mask_ours_.push_back(
        timed([&] { (void)thin(thinned_.view(), thinning_.memory(), chain_->kernels.vision.thin); }));
    cv::Mat theirs;
    same_mask_opencv_.push_back(opencv_thinning(lines, theirs));
    iou_same_mask_.push_back(overlap(to_mat(thinned_.view()), theirs));
  }

  const FramePool& pool_;
  std::unique_ptr<ChainUnderTest<>> chain_;
  OpenCvChain opencv_;
  std::vector<Vec3> rays_;
  RayGridView grid_;
  BitImage<width, height> seen_, ground_, thinned_, scratch_mask_;
  test::OwnThinningMemory thinning_{width, height};
  std::vector<std::uint8_t> target_;

  host::StageTimes ours_{};
  double localize_us_ = 0.0;
  double kinder_us_ = 0.0;
  PairedResult result_;
  std::array<Samples, 16> group_ours_, group_opencv_;
  Samples ours_average_, result_kinder_, vision_ours_, vision_opencv_, same_mask_ours_, same_mask_opencv_, memcpy_,
      frame_to_pose_, first_pose_, localize_, line_points_, features_;
  Samples iou_green_, iou_roi_, iou_lines_, lines_covered_, iou_skeleton_, skeleton_covered_, iou_same_mask_;
};

}  // namespace

PairedResult run_paired(const FramePool& pool, int rounds, const KernelChoice& kernels) {
  prepare_opencv();
  PairedRun run(pool, kernels);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < pool.views.size(); ++i) run.run_view(i, (i + static_cast<std::size_t>(round)) % 2 == 0);
  }
  for (const View& view : pool.views) run.first_pose(view);
  return run.finish();
}

}  // namespace touchline::bench
