// SPDX-License-Identifier: Apache-2.0
// Runs a data set through the chain by its protocol and judges every pose.
#include "platform/host/evaluate.h"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "platform/host/frame_pictures.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "platform/host/overlay.h"

namespace touchline::host {
namespace {

double time_of(const DataFrame& frame, std::size_t index) {
  return frame.has_time ? frame.time_s : static_cast<double>(index) * default_frame_s;
}

LocalizerInput input_of(const DataFrame& frame, double time_s, const EvaluateOptions& options) {
  LocalizerInput input;
  input.time_s = time_s;
  if (frame.has_odometry) input.odometry = frame.odometry;
  input.has_yaw = frame.has_yaw && options.use_yaw;
  input.yaw = frame.yaw;
  return input;
}

/// Shows what was seen to the filter until it settles.
void show(Chain& chain, LocalizerInput input, int most, StageObserver& clock, FrameRecord& record) {
  while (record.shows < most && !record.settled) {
    record.estimate = chain.locate(input, &clock);
    record.settled = record.estimate.settled;
    ++record.shows;
    input.odometry = {};
    input.time_s += default_frame_s;
  }
}

void judge_record(FrameRecord& record, const VisionResult& vision) {
  if (record.frame.has_truth) record.error = judge(record.frame.truth, record.estimate);
  if (const auto expected = read_expected(record.frame.path)) {
    std::vector<Junction> reported;
    for (const KnownJunction& known : record.junctions) reported.push_back(known.junction);
    record.junction_score = score_junctions(*expected, reported);
    record.seen_junction_score = score_junctions(*expected, vision.features->junctions.span());
  }
}

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char text[160];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

std::vector<std::string> panel_text(const FrameRecord& record, const VisionResult& vision) {
  std::vector<std::string> lines{record.frame.image};
  const auto& e = record.estimate;
  const auto number = [](float v) { return static_cast<double>(v); };
  if (e.valid) {
    lines.push_back(
        formatted("pose %.3f %.3f m %.1f deg", number(e.pose.x), number(e.pose.y), number(degrees(e.pose.theta))));
    lines.push_back(formatted("confidence %.2f, explained %.2f", number(e.confidence), number(e.explained)));
    lines.push_back(
        formatted("pitch error %.2f, roll %.2f deg", number(degrees(e.pitch_error)), number(degrees(e.roll_error))));
  } else {
    lines.emplace_back("no pose");
  }
  if (record.error && record.error->has_pose) {
    lines.push_back(formatted("error %.3f m %.2f deg%s%s", record.error->distance_m, record.error->angle_deg,
                              record.error->wrong_half ? ", WRONG HALF" : "",
                              record.error->outside_3_sigma ? ", > 3 sigma" : ""));
  }
  lines.push_back(formatted("shown %d times%s", record.shows, record.settled ? "" : ", not settled"));
  const auto& c = vision.counts;
  lines.push_back(formatted("mean of %d frames, %d left out", c.frames_in_mean, c.frames_left_out));
  lines.push_back(formatted("nodes %d, edges %d", static_cast<int>(vision.graph.nodes.size()),
                            static_cast<int>(vision.graph.edges.size())));
  lines.push_back(formatted("junctions %d, turned down %d", static_cast<int>(vision.features->junctions.size()),
                            static_cast<int>(vision.features->rejections.size())));
  const auto by_map = std::count_if(record.junctions.begin(), record.junctions.end(),
                                    [](const auto& known) { return known.source == JunctionSource::map; });
  lines.push_back(formatted("the map adds %d, turns down %d", static_cast<int>(by_map), record.junctions_turned_down));
  lines.push_back(formatted("line points %d, posts %d", static_cast<int>(vision.features->line_points.size()),
                            static_cast<int>(vision.features->posts.size())));
  return lines;
}

void write_overlay(const std::filesystem::path& file, const FrameRecord& record, const RgbImage& picture,
                   Chain& chain) {
  OverlayInput input;
  input.picture = &picture;
  input.vision = &chain.vision();
  input.field = &chain.field();
  input.estimate = record.estimate;
  input.known = record.junctions;
  input.has_truth = record.frame.has_truth;
  input.truth = record.frame.truth;
  input.particles = chain.particles();
  input.text = panel_text(record, chain.vision());
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  if (failed) {
    throw HostError(file.parent_path().string() + ": cannot be made: " + failed.message() +
                    "; choose another --frames folder");
  }
  write_png(file, draw_overlay(input));
}

void add_sequence_score(SetResult& result) {
  std::vector<JudgedFrame> judged;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const auto& record = result.frames[i];
    if (record.error) judged.push_back({time_of(record.frame, i), record.frame.kidnap, *record.error});
  }
  if (!judged.empty()) result.sequence = judge_sequence(judged);
}

/// One run through a data set, frame by frame.
class Run {
 public:
  Run(const DataSet& set, const EvaluateOptions& options)
      : set_(set),
        options_(options),
        independent_(set.protocol == Protocol::independent),
        chain_(options.chain, set.field),
        names_(picture_names(set.frames)) {}

  FrameRecord frame(std::size_t index) {
    FrameRecord record;
    record.frame = set_.frames[index];
    take_over(record.frame);
    try {
      use(record, index);
    } catch (const FrameError& error) {
      leave_out(record, error.what());
    }
    return record;
  }

 private:
  /// What the frames that were left out before would have told.
  void take_over(DataFrame& frame) const {
    frame.kidnap = frame.kidnap || left_kidnap_;
    if (!left_odometry_) return;
    frame.odometry = frame.has_odometry ? compose(*left_odometry_, frame.odometry) : *left_odometry_;
    frame.has_odometry = true;
  }

  void use(FrameRecord& record, std::size_t index) {
    const bool start = independent_ || !started_;
    const RgbImage picture = read_frame_image(record.frame);
    const double time_s = time_of(record.frame, index);
    if (start) chain_.forget(options_.seed + (independent_ ? index : 0U));
    clock_.clear();
    LocalizerInput input = input_of(record.frame, time_s, options_);
    if (start) input.odometry = {};
    const VisionResult& vision = chain_.see(picture.view(), time_s, record.frame.camera, input.odometry, &clock_);
    show(chain_, input, independent_ ? max_shows : 1, clock_, record);
    started_ = true;
    left_odometry_.reset();
    left_kidnap_ = false;
    record.us = clock_.times();
    check(record, vision);
    record.posts.assign(vision.features->posts.begin(), vision.features->posts.end());
    judge_record(record, vision);
    if (options_.frames_out.empty()) return;
    write_overlay(picture_folder(options_.frames_out, set_.name) / names_[index], record, picture, chain_);
  }

  void check(FrameRecord& record, const VisionResult& vision) const {
    KnownJunctions known;
    check_junctions(chain_.field(), vision, record.estimate, LocalizerConfig{}.confident, known);
    record.junctions.assign(known.list.begin(), known.list.end());
    record.junctions_turned_down = known.turned_down;
  }

  void leave_out(FrameRecord& record, const char* why) {
    const bool unseen = record.shows == 0;  // or it is the judge who could not use the frame
    if (!independent_ && unseen && record.frame.has_odometry) left_odometry_ = record.frame.odometry;
    left_kidnap_ = !independent_ && record.frame.kidnap;
    const DataFrame frame = record.frame;
    record = {};
    record.frame = frame;
    record.failure = why;
  }

  const DataSet& set_;
  const EvaluateOptions& options_;
  bool independent_;
  Chain chain_;
  StageClock clock_;
  std::vector<std::string> names_;  // of the annotated pictures
  bool started_ = false;
  std::optional<Pose2> left_odometry_;
  bool left_kidnap_ = false;
};

}  // namespace

std::string folder_name(const std::string& set_name) {
  std::string name = set_name;
  std::replace(name.begin(), name.end(), '/', '_');
  return name.empty() || name == "." || name == ".." ? "set" : name;
}

SetResult evaluate(const DataSet& set, const EvaluateOptions& options,
                   const std::function<void(const FrameRecord&)>& on_frame) {
  SetResult result;
  result.name = set.name;
  result.protocol = set.protocol;
  Run run(set, options);
  for (std::size_t i = 0; i < set.frames.size(); ++i) {
    result.frames.push_back(run.frame(i));
    if (on_frame) on_frame(result.frames.back());
  }
  if (set.protocol == Protocol::sequence) add_sequence_score(result);
  return result;
}

int Summary::within(double metres) const {
  return static_cast<int>(std::count_if(distances_m.begin(), distances_m.end(), [&](double d) { return d <= metres; }));
}

int Summary::within(double metres, double degrees) const {
  int count = 0;
  for (std::size_t i = 0; i < distances_m.size(); ++i)
    count += distances_m[i] <= metres && angles_deg[i] <= degrees ? 1 : 0;
  return count;
}

Summary summarize(std::span<const FrameRecord* const> frames) {
  Summary sum;
  double shows = 0.0;
  std::array<std::vector<double>, stage_count> us;
  for (const FrameRecord* record : frames) {
    ++sum.frames;
    if (!record->failure.empty()) {
      ++sum.failed;
      continue;
    }
    sum.with_pose += record->estimate.valid ? 1 : 0;
    shows += record->shows;
    sum.most_shows = std::max(sum.most_shows, record->shows);
    sum.not_settled += record->settled ? 0 : 1;
    for (std::size_t i = 0; i < stage_count; ++i) us[i].push_back(record->us[i]);
    if (record->junction_score) {
      sum.has_junctions = true;
      sum.junctions += *record->junction_score;
      sum.seen_junctions += *record->seen_junction_score;
    }
    if (!record->error) continue;
    ++sum.with_truth;
    const PoseError& error = *record->error;
    sum.without_pose += error.has_pose ? 0 : 1;
    sum.wrong_half += error.wrong_half ? 1 : 0;
    sum.outside_3_sigma += error.outside_3_sigma ? 1 : 0;
    const double infinite = std::numeric_limits<double>::infinity();
    sum.distances_m.push_back(error.has_pose ? error.distance_m : infinite);
    sum.angles_deg.push_back(error.has_pose ? error.angle_deg : infinite);
  }
  if (sum.frames > sum.failed) sum.mean_shows = shows / (sum.frames - sum.failed);
  for (std::size_t i = 0; i < stage_count; ++i) sum.median_us[i] = us[i].empty() ? 0.0 : quantile(us[i], 0.5);
  return sum;
}

Summary summarize(const SetResult& set) {
  std::vector<const FrameRecord*> frames;
  for (const auto& record : set.frames) frames.push_back(&record);
  return summarize(frames);
}

}  // namespace touchline::host
