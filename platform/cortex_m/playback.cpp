// SPDX-License-Identifier: Apache-2.0
#include "platform/cortex_m/playback.h"

#include <algorithm>

#include "platform/cortex_m/board.h"
#include "platform/cortex_m/text.h"
#include "tests/golden/product_hashes.h"
#include "vision/stage.h"

namespace touchline::board {
namespace {

constexpr std::uint64_t seed = 1;
constexpr std::size_t stage_count = static_cast<std::size_t>(Stage::count);
constexpr std::size_t max_frames = 64;  // 10 MB of pixels: more than any flash here has

/// Instructions of each stage.
// NOLINTNEXTLINE(cppcoreguidelines-virtual-class-destructor): final, and never deleted through its base
class StageCounter final : public StageObserver {
 public:
  [[nodiscard]] std::uint64_t of(std::size_t stage) const { return spent_[stage]; }

 private:
  void do_begin(Stage) override { began_ = instructions(); }
  void do_end(Stage stage) override { spent_[static_cast<std::size_t>(stage)] += instructions() - began_; }

  std::uint64_t began_ = 0;
  std::array<std::uint64_t, stage_count> spent_{};
};

bool refused(const char* what, Status status) {
  if (status == Status::ok) return false;
  print(Text().add("refused: ").add(what).add(" (").add(to_string(status)).add(")\n").c_str());
  return true;
}

bool configure(const Recording& recording, Chain& chain) {
  const std::optional<FieldDimensions> dimensions = field_preset(recording.field);
  if (!dimensions) return !refused("the recording's field is no preset", Status::invalid_argument);
  Field field;
  if (refused("field", Field::create(*dimensions, field))) return false;
  if (refused("localizer", chain.localizer.configure(LocalizerConfig{}, field))) return false;
  Lens lens;
  if (refused("lens", Lens::create(recording.lens, lens))) return false;
  VisionConfig config;
  config.frame_width = frame_width;
  config.frame_height = frame_height;
  config.fifo_depth = 1;
  config.line_width_m = dimensions->line_width;
  config.post_diameter_m = dimensions->post_diameter;
  const char* key = "vision";
  if (refused(key, chain.pipeline.configure(config, lens, &key))) return false;
  (void)chain.localizer.reset(Prior{}, seed);
  return true;
}

void print_products(std::size_t number, const VisionResult& vision, const PoseEstimate& estimate) {
  for (const test::ProductHash& product : test::hash_products(vision)) {
    print(Text()
              .add("frame ")
              .add(number)
              .add(" ")
              .add(product.name)
              .to_column(22)
              .add_hex(product.hash)
              .add("\n")
              .c_str());
  }
  Text seen;
  seen.add("frame ")
      .add(number)
      .add(" seen")
      .to_column(22)
      .add(vision.features->line_points.size())
      .add(" line points, ");
  seen.add(vision.features->junctions.size())
      .add(" junctions, ")
      .add(vision.counts.skeleton_pixels)
      .add(" skeleton pixels\n");
  print(seen.c_str());
  Text pose;
  pose.add("frame ").add(number).add(" pose").to_column(22).add_hex(test::hash_estimate(estimate));
  if (estimate.valid) {
    pose.add("  x ").add_decimal(estimate.pose.x, 4).add(" m, y ").add_decimal(estimate.pose.y, 4).add(" m, theta ");
    pose.add_decimal(degrees(estimate.pose.theta), 3).add(" deg, confidence ").add_decimal(estimate.confidence, 3);
  }
  print(pose.add("\n").c_str());
}

void print_cost(std::size_t number, const StageCounter& stages, std::uint64_t total) {
  print(Text().add("cost ").add(number).add(" total ").add(total).add("\n").c_str());
  for (std::size_t stage = 0; stage < stage_count; ++stage) {
    if (stages.of(stage) == 0) continue;
    print(Text()
              .add("cost ")
              .add(number)
              .add(" ")
              .add(to_string(static_cast<Stage>(stage)))
              .add(" ")
              .add(stages.of(stage))
              .add("\n")
              .c_str());
  }
}

/// One frame from pixels to pose; its instructions in `total`.
bool play_frame(const Recording& recording, std::size_t number, Chain& chain, std::uint64_t& total) {
  const RecordedFrame& frame = recording.frames[number];
  const std::uint8_t* pixels = recording.pixels + number * frame_bytes;
  std::copy(pixels, pixels + frame_bytes, chain.frame.begin());
  FrameInput input;
  input.image = {PixelFormat::yuyv, chain.frame.data(), frame_width, frame_height, frame_width * 2};
  input.time_s = frame.time_s;
  input.camera = frame.camera;
  input.odometry = frame.odometry;
  LocalizerInput motion;
  motion.time_s = frame.time_s;
  motion.odometry = frame.odometry;
  motion.has_yaw = frame.has_yaw;
  motion.yaw = frame.yaw;

  StageCounter stages;
  PoseEstimate estimate;
  const std::uint64_t began = instructions();
  if (refused("frame, by vision", chain.pipeline.process(input, chain.vision, &stages))) return false;
  if (refused("frame, by localization", chain.localizer.update(motion, chain.vision, estimate, &stages))) return false;
  total = instructions() - began;
  print_products(number, chain.vision, estimate);
  if (total != 0) print_cost(number, stages, total);
  return true;
}

}  // namespace

bool play(const Recording& recording, Chain& chain) {
  if (!configure(recording, chain)) return false;
  std::array<std::uint64_t, max_frames> totals{};
  const std::size_t count = std::min(recording.frames.size(), max_frames);
  if (count == 0) return !refused("the recording is empty", Status::end_of_data);
  for (std::size_t number = 0; number < count; ++number) {
    if (!play_frame(recording, number, chain, totals[number])) return false;
  }
  std::sort(totals.begin(), totals.begin() + static_cast<std::ptrdiff_t>(count));
  if (totals[0] != 0) {
    print(Text().add("instructions_median ").add(totals[count / 2]).add("\n").c_str());
    print(Text().add("instructions_worst ").add(totals[count - 1]).add("\n").c_str());
  }
  return true;
}

}  // namespace touchline::board
