// SPDX-License-Identifier: Apache-2.0
#include "vision/pipeline.h"

#include <algorithm>

#include "platform/core/elementary.h"
#include "vision/candidates.h"
#include "vision/digestion.h"
#include "vision/edge_zone.h"
#include "vision/ground_mask.h"
#include "vision/image/bit_ops.h"
#include "vision/image/hsv.h"
#include "vision/image/hull.h"
#include "vision/image/morphology.h"
#include "vision/junction_places.h"
#include "vision/line_mask.h"
#include "vision/line_points.h"
#include "vision/node_graph.h"
#include "vision/short_pieces.h"
#include "vision/white_search.h"

namespace touchline {
namespace {

bool within(float x, float limit) { return x >= -limit && x <= limit; }  // NaN is not

bool is_valid(const CameraPose& pose) {
  return within(pose.x, max_camera_reach_m) && within(pose.y, max_camera_reach_m) && pose.height > 0.0F &&
         pose.height <= max_camera_reach_m && within(pose.yaw, max_camera_angle) &&
         within(pose.pitch, max_camera_angle) && within(pose.roll, max_camera_angle);
}
bool is_valid(const Pose2& pose) {
  return math::is_finite(pose.x) && math::is_finite(pose.y) && math::is_finite(pose.theta);
}

Status refuse(const char** what, const char* key) {
  if (what != nullptr) *what = key;
  return Status::invalid_argument;
}

constexpr int reference_width = 320;  // lengths of the configuration are in working pixels of this width

}  // namespace

Status Pipeline::configure(const VisionConfig& config, const Lens& lens, const char** what) {
  if (const Status status = check_config(config, what); status != Status::ok) return status;
  if (!(lens.parameters().focal_px > 0.0F)) return refuse(what, "lens");  // never created
  if (static_cast<std::size_t>(config.fifo_depth) > memory_.depth) return refuse(what, "fifo_depth");
  PipelineViews views;
  if (!make_views(memory_, config.work_width, config.work_height, views)) return refuse(what, "work_width");
  const Status status = subsampler_.configure(config.frame_width, config.frame_height, config.work_width,
                                              config.work_height, config.kernels);
  if (status != Status::ok) {
    (void)refuse(what, "frame_width");
    return status;
  }
  config_ = config;
  lens_ = lens;
  views_ = views;
  fifo_ = FrameFifo({views_.slots.data(), static_cast<std::size_t>(config.fifo_depth)}, config.kernels);
  make_ray_grid(lens, config.frame_width, config.frame_height, config.work_width, config.work_height, views_.rays);
  make_seen_mask(lens, config.frame_width, config.frame_height, config.body_mask.span(), views_.mask(MaskId::seen));
  configured_ = true;
  return Status::ok;
}

void Pipeline::reset() { fifo_.reset(); }

Status Pipeline::process(const FrameInput& input, VisionResult& result, StageObserver* observer) {
  if (!configured_) return Status::not_ready;
  if (input.image.width != config_.frame_width || input.image.height != config_.frame_height) return Status::wrong_size;
  if (!is_valid(input.camera) || !is_valid(input.odometry) || !(input.time_s - input.time_s == 0.0)) {
    return Status::invalid_argument;
  }
  VisionResult next;
  next.time_s = input.time_s;
  next.projection = GroundProjection(lens_, input.camera);
  next.frame_width = config_.frame_width;
  next.frame_height = config_.frame_height;
  next.work_width = views_.width;
  next.work_height = views_.height;
  {
    const StageScope scope(observer, Stage::average);
    if (const Status status = average(input, next); status != Status::ok) return status;
  }
  const auto run = [&](Stage stage, void (Pipeline::*step)(VisionResult&)) {
    const StageScope scope(observer, stage);
    (this->*step)(next);
  };
  run(Stage::green, &Pipeline::find_green_stage);
  run(Stage::roi, &Pipeline::find_roi);
  run(Stage::candidates, &Pipeline::find_candidates);
  run(Stage::line_mask, &Pipeline::make_line_mask);
  run(Stage::thinning, &Pipeline::make_skeleton);
  run(Stage::digestion, &Pipeline::digest_skeleton);
  run(Stage::graph, &Pipeline::build_graph);
  run(Stage::junctions, &Pipeline::find_features);
  run(Stage::posts, &Pipeline::find_goal_posts);
  run(Stage::line_points, &Pipeline::make_line_points);
  next.features = memory_.features;
  result = next;
  return Status::ok;
}

Status Pipeline::average(const FrameInput& input, VisionResult& result) {
  if (const Status status = subsampler_.run(input.image, fifo_.next_slot()); status != Status::ok) return status;
  fifo_.push();
  movement_.remember(input.camera, input.odometry);
  const float px_a_radian = lens_.parameters().focal_px * work_px_per_frame_px();
  std::array<bool, max_fifo_depth> still{};
  for (int age = 0; age < fifo_.size(); ++age) {
    still[static_cast<std::size_t>(age)] = movement_.since(age) * px_a_radian < 1.0F;
  }
  result.mean = fifo_.mean_of_still(still);
  result.counts.frames_in_mean = fifo_.frames_in_mean();
  result.counts.frames_left_out = fifo_.size() - fifo_.frames_in_mean();
  return Status::ok;
}

void Pipeline::find_green_stage(VisionResult& result) {
  const CameraPose& pose = result.projection.pose();
  const BitView& ground = views_.mask(MaskId::ground);
  make_ground_mask(views_.rays, pose, config_.max_range_m, views_.mask(MaskId::seen), ground);
  make_line_width_table(views_.rays, pose, config_.line_width_m, views_.line_widths, config_.kernels);
  result.line_widths = views_.line_widths;
  carpet_ = measure_carpet(result.mean, ground, config_.green, views_.mask(MaskId::green), config_.kernels);
  find_white(result.mean, ground, carpet_, views_.mask(MaskId::white), config_.kernels);
  // What is white between green belongs to the field, or a wide line would cut it in two.
  const BitView& candidates = views_.mask(MaskId::candidates);
  const SpanCounts spans = find_white_spans(result.mean, views_.mask(MaskId::green), views_.mask(MaskId::white),
                                            result.line_widths, carpet_, candidates, config_.kernels);
  result.counts.rejected_candidates = {spans.too_wide, spans.too_thin, spans.not_white, spans.not_bright};
  const BitView& clean = views_.mask(MaskId::clean_green);
  copy(views_.mask(MaskId::green), clean);
  or_with(clean, candidates);
  erode(clean, scaled(config_.green_erode_px), config_.kernels.join_squares);
  dilate(clean, scaled(config_.green_dilate_px), config_.kernels.join_squares);
  result.green = clean;
  result.counts.green_pixels = count(clean, config_.kernels);
}

void Pipeline::find_roi(VisionResult& result) {
  const BitView& field = views_.mask(MaskId::field);
  const BitView& roi = views_.mask(MaskId::roi);
  clear(roi);
  const BlobCount blobs = find_blobs(result.green, memory_.blob_search, memory_.blobs);
  result.counts.dropped_blobs = blobs.dropped;
  const std::span<const Blob> found = memory_.blobs.first(static_cast<std::size_t>(blobs.found));
  const int largest = largest_blob(found);
  if (largest < 0) {
    clear(field);
  } else {
    cut_out(result.green, found, static_cast<std::size_t>(largest), blobs.dropped == 0, field, roi);
    const int corners = hull_of_mask(field, memory_.hull_scratch, memory_.hull);
    result.hull = memory_.hull.first(static_cast<std::size_t>(corners));
    fill_hull(roi, result.hull);
    and_with(roi, views_.mask(MaskId::ground));
  }
  result.field = field;
  result.roi = roi;
  result.counts.roi_pixels = count(roi, config_.kernels);
}

void Pipeline::find_candidates(VisionResult& result) {
  const BitView& candidates = views_.mask(MaskId::candidates);
  const BitView& roi = views_.mask(MaskId::roi);
  and_with(candidates, roi);
  const GrowResult ridges = find_white_ridges(result.mean, roi, views_.mask(MaskId::green), result.line_widths, carpet_,
                                              candidates, views_.mask(MaskId::scratch), config_.kernels);
  const BitView& edges = views_.mask(MaskId::edges);
  // An edge beside a line that is found already adds nothing. The line mask is made later: its memory is free.
  const BitView& zone = views_.mask(MaskId::line_mask);
  find_edge_zone({views_.mask(MaskId::white), views_.mask(MaskId::green), roi, candidates, result.line_widths}, zone);
  const GrowResult grown = find_edges(result.mean.y, zone, edge_thresholds(carpet_), memory_.canny,
                                      views_.mask(MaskId::scratch), edges, config_.kernels);
  result.counts.dropped_edge_seeds = (ridges.finished ? 0 : 1) + (grown.finished ? 0 : 1);
  const EdgeInput input{result.mean.y,      edges,          views_.mask(MaskId::green), views_.mask(MaskId::white),
                        result.line_widths, config_.kernels};
  add_line_edges(input, candidates, result.counts.rejected_candidates);
  and_with(candidates, roi);
  result.edges = edges;
  result.candidates = candidates;
  result.counts.candidate_pixels = count(candidates, config_.kernels);
}

void Pipeline::make_line_mask(VisionResult& result) {
  const BitView& lines = views_.mask(MaskId::line_mask);
  const BitView& white = views_.mask(MaskId::white);
  copy(views_.mask(MaskId::candidates), lines);
  and_with(white, views_.mask(MaskId::roi));
  grow_into_white(white, result.line_widths, lines, views_.mask(MaskId::scratch), config_.kernels);
  trim_to_half_level(result.mean.y, lines, views_.mask(MaskId::scratch), config_.kernels);
  close_lines(views_.mask(MaskId::green), scaled(config_.line_dilate_px), scaled(config_.line_erode_px), lines,
              views_.mask(MaskId::scratch), config_.kernels);
  and_with(lines, views_.mask(MaskId::roi));
  find_post_colour(result);
  if (!config_.white_posts) and_not_with(lines, views_.mask(MaskId::post_colour));
  result.line_mask = lines;
  result.counts.line_pixels = count(lines, config_.kernels);
}

void Pipeline::make_skeleton(VisionResult& result) {
  const BitView& skeleton = views_.mask(MaskId::skeleton);
  copy(views_.mask(MaskId::line_mask), skeleton);
  thin(skeleton, memory_.thinning, config_.kernels.thin);
  const PieceCounts pieces = remove_short_pieces(skeleton, result.line_widths, scaled(5), memory_.pieces);
  result.counts.dropped_points = pieces.overflowed;
  result.skeleton = skeleton;
  result.counts.skeleton_pixels = count(skeleton, config_.kernels);
}

void Pipeline::digest_skeleton(VisionResult& result) {
  (void)index_.build(result.skeleton);  // the memory was checked against the working size
  const DigestionParameters parameters{scaled_length(config_.digestion_radius_px), config_.low_weight,
                                       config_.medium_weight, config_.high_weight};
  const DigestionResult digested = digest(index_, parameters, memory_.graph.digestion);
  result.major_nodes = digested.major_nodes;
  result.counts.major_nodes = static_cast<int>(digested.major_nodes.size());
  result.counts.dropped_points += index_.dropped();
  result.counts.dropped_nodes = digested.dropped;
}

void Pipeline::build_graph(VisionResult& result) {
  const NodeGraphResult built = build_node_graph(index_, result.major_nodes, result.line_widths,
                                                 {scaled_length(config_.spur_px)}, memory_.graph.graph);
  result.graph = built.graph;
  result.counts.dropped_points += built.dropped_points;
  result.counts.dropped_nodes += built.dropped_nodes;
  result.counts.dropped_edges = built.dropped_edges;
}

void Pipeline::find_features(VisionResult& result) {
  FeatureWork& work = *memory_.feature_work;
  Features& features = *memory_.features;
  features.junctions.clear();
  features.rejections.clear();
  const WorkRays rays(result.projection, views_.rays, config_.frame_width, config_.frame_height, views_.width,
                      views_.height);
  const FieldView field{result.line_mask, result.green, views_.mask(MaskId::green), result.roi};
  find_line_segments(result.graph, rays, field, {config_.line_width_m, config_.max_range_m}, memory_.edge_done,
                     work.lines);
  features.has_circle =
      find_circle(work.lines, rays, {config_.circle_radius_m, config_.line_width_m}, work.circle, features.circle);
  const SeenCircle circle{features.circle, work.circle.seen, config_.circle_radius_m};
  const int dropped = find_junctions(work.lines, features.has_circle ? &circle : nullptr, rays, field,
                                     {config_.line_width_m, config_.max_range_m}, work.junctions, features);
  result.counts.dropped_junctions =
      dropped + work.lines.left_out + static_cast<int>(work.lines.segments.dropped() + work.lines.points.dropped());
}

/// A post's edges are as bright beside the carpet as a line's: what has its colour is no line.
void Pipeline::find_post_colour(const VisionResult& result) {
  const BitView& colour = views_.mask(MaskId::post_colour);
  hsv_in_range(result.mean, config_.white_posts ? config_.white_post : config_.yellow_post, views_.mask(MaskId::seen),
               colour, config_.kernels);
}

void Pipeline::find_goal_posts(VisionResult& result) {
  const WorkRays rays(result.projection, views_.rays, config_.frame_width, config_.frame_height, views_.width,
                      views_.height);
  result.counts.dropped_posts = find_posts(
      views_.mask(MaskId::post_colour), rays, {result.line_mask, result.green, views_.mask(MaskId::green), result.roi},
      {config_.post_diameter_m, config_.max_range_m}, memory_.feature_work->posts, memory_.features->posts);
}

void Pipeline::make_line_points(VisionResult& result) {
  const WorkRays rays(result.projection, views_.rays, config_.frame_width, config_.frame_height, views_.width,
                      views_.height);
  const LinePointInput input{result.mean.y,        result.skeleton,     result.line_mask, rays,
                             config_.line_width_m, config_.max_range_m, config_.kernels};
  const LinePointCounts counts = find_line_points(input, views_.mask(MaskId::scratch), memory_.features->line_points);
  result.counts.dropped_line_points = counts.dropped;
  place_junctions(input, *memory_.features);
}

/// The larger of both directions.
float Pipeline::work_px_per_frame_px() const {
  return math::max(static_cast<float>(views_.width) / static_cast<float>(config_.frame_width),
                   static_cast<float>(views_.height) / static_cast<float>(config_.frame_height));
}

/// A kernel or radius of the configuration at the working width, odd.
int Pipeline::scaled(int px) const {
  const int length = (px * views_.width + reference_width / 2) / reference_width;
  return std::max(length | 1, 1);
}

/// A length of the configuration at the working width.
int Pipeline::scaled_length(int px) const { return (px * views_.width + reference_width / 2) / reference_width; }

}  // namespace touchline
