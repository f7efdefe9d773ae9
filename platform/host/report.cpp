// SPDX-License-Identifier: Apache-2.0
// What an evaluation says.
#include "platform/host/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <limits>
#include <ostream>

#include <nlohmann/json.hpp>

namespace touchline::host {
namespace {

using json = nlohmann::ordered_json;  // keys stay in the order that the documentation gives

/// Rounded, so that a line stays readable; null for what is no number.
json rounded(double value, double step) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value / step) * step == 0.0 ? json(0.0) : json(std::round(value / step) / std::round(1.0 / step));
}
json metres(float value) { return rounded(static_cast<double>(value), 1e-4); }
json angle(float value) { return rounded(static_cast<double>(degrees(value)), 1e-3); }
json share(float value) { return rounded(static_cast<double>(value), 1e-3); }
json pixels(float value) { return rounded(static_cast<double>(value), 1e-2); }

/// File names may hold any bytes; what is no UTF-8 becomes the replacement character.
std::string in_utf8(const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); }

json pose_json(const Pose2& pose) {
  return {{"x_m", metres(pose.x)}, {"y_m", metres(pose.y)}, {"theta_deg", angle(pose.theta)}};
}

json std_json(const PoseCovariance& c) {
  return {{"x_m", metres(std::sqrt(c.xx))}, {"y_m", metres(std::sqrt(c.yy))}, {"theta_deg", angle(std::sqrt(c.tt))}};
}

json mirror_json(const PoseEstimate& estimate) {
  if (!estimate.valid || !estimate.has_mirror) return nullptr;
  json out = pose_json(estimate.mirror);
  out["confidence"] = share(estimate.mirror_confidence);
  return out;
}

json landmark_json(const PixelPoint& pixel, const GroundPoint& ground, float confidence) {
  return {{"u_px", pixels(pixel.u)},
          {"v_px", pixels(pixel.v)},
          {"x_m", metres(ground.x)},
          {"y_m", metres(ground.y)},
          {"confidence", share(confidence)}};
}

json junctions_json(const std::vector<KnownJunction>& junctions) {
  json out = json::array();
  for (const auto& [j, source] : junctions) {
    json entry = {{"type", to_string(j.type)}};
    entry.update(landmark_json(j.pixel, j.ground, j.confidence));
    entry["source"] = to_string(source);
    out.push_back(entry);
  }
  return out;
}

json posts_json(const std::vector<PostObservation>& posts) {
  json out = json::array();
  for (const auto& p : posts) out.push_back(landmark_json(p.pixel, p.ground, p.confidence));
  return out;
}

json times_json(const StageTimes& us) {
  json out = json::object();
  for (std::size_t i = 0; i < stage_count; ++i) out[to_string(static_cast<Stage>(i))] = rounded(us[i], 0.1);
  return out;
}

json error_json(const PoseError& error) {
  if (!error.has_pose) return nullptr;
  return {{"m", rounded(error.distance_m, 1e-4)},
          {"deg", rounded(error.angle_deg, 1e-3)},
          {"wrong_half", error.wrong_half},
          {"outside_3_sigma", error.outside_3_sigma}};
}

json junction_score_json(const JunctionScore& score) {
  json out = json::object();
  for (const auto type : {JunctionType::x, JunctionType::t, JunctionType::l}) {
    const auto& c = score[static_cast<std::size_t>(type)];
    out[to_string(type)] = {{"to_find", c.to_find},
                            {"found", c.found},
                            {"right", c.right},
                            {"wrong", c.wrong},
                            {"precision", rounded(c.precision(), 1e-4)},
                            {"recall", rounded(c.recall(), 1e-4)}};
  }
  return out;
}

json figures(const Summary& s) {
  json out = {{"frames", s.frames}, {"failed", s.failed}, {"with_pose", s.with_pose}, {"with_truth", s.with_truth}};
  if (s.with_truth > 0) {
    out["without_pose"] = s.without_pose;
    out["wrong_half"] = s.wrong_half;
    out["outside_3_sigma"] = s.outside_3_sigma;
    out["median_m"] = rounded(s.median_m(), 1e-4);
    out["p90_m"] = rounded(quantile(s.distances_m, 0.9), 1e-4);
    out["worst_m"] = rounded(s.worst_m(), 1e-4);
    out["median_deg"] = rounded(s.median_deg(), 1e-3);
    out["worst_deg"] = rounded(quantile(s.angles_deg, 1.0), 1e-3);
    for (const int cm : {5, 10, 20, 30, 40}) out["within_" + std::to_string(cm) + "_cm"] = s.within(cm * 0.01);
  }
  if (s.has_junctions) {
    out["junctions"] = junction_score_json(s.junctions);
    out["junctions_by_vision"] = junction_score_json(s.seen_junctions);
  }
  out["shows_mean"] = rounded(s.mean_shows, 1e-2);
  out["shows_most"] = s.most_shows;
  out["us_median"] = times_json(s.median_us);
  return out;
}

json sequence_json(const SequenceScore& score) {
  json back = json::array();
  for (const auto& seconds : score.back_s) back.push_back(seconds ? rounded(*seconds, 1e-3) : json(nullptr));
  return {{"counted", score.counted},
          {"without_pose", score.without_pose},
          {"rmse_m", rounded(score.rmse_m, 1e-4)},
          {"rmse_deg", rounded(score.rmse_deg, 1e-3)},
          {"back_s", back}};
}

template <typename... Values>
void print(std::ostream& out, const char* format, Values... values) {
  char text[240];
  std::snprintf(text, sizeof text, format, values...);
  out << text;
}

double number(float value) { return static_cast<double>(value); }
double percent(int part, int whole) { return whole > 0 ? 100.0 * part / whole : 0.0; }

/// "-" where there is no such number.
std::string in(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}
std::string in_metres(double value) { return in("%.3f m", value); }
std::string in_degrees(double value) { return in("%.2f deg", value); }
std::string in_percent(double share) { return in("%.0f %%", 100.0 * share); }

void print_errors(std::ostream& out, const Summary& s) {
  out << "  error: median " << in_metres(s.median_m()) << " " << in_degrees(s.median_deg()) << ", 90 % within "
      << in_metres(quantile(s.distances_m, 0.9)) << ", worst " << in_metres(s.worst_m()) << "\n";
  print(out, "  within 0.05 m: %d, 0.10 m: %d, 0.20 m: %d, 0.40 m: %d of %d; wrong half: %d; no pose: %d\n",
        s.within(0.05), s.within(0.10), s.within(0.20), s.within(0.40), s.with_truth, s.wrong_half, s.without_pose);
  print(out, "  truth outside 3 sigma: %d of %d frames (%.1f %%)\n", s.outside_3_sigma, s.with_truth,
        percent(s.outside_3_sigma, s.with_truth));
}

void print_sequence(std::ostream& out, const SequenceScore& score) {
  if (score.counted == 0) {
    out << "  sequence: RMSE - over 0 frames that count: the first second and the one after a kidnap do not\n";
  } else {
    out << "  sequence: RMSE " << in_metres(score.rmse_m) << " " << in_degrees(score.rmse_deg) << " over "
        << score.counted << " frames that count, " << score.without_pose << " of them without a pose\n";
  }
  for (const auto& seconds : score.back_s) {
    if (seconds) {
      print(out, "  kidnap: back after %.2f s\n", *seconds);
    } else {
      out << "  kidnap: never back\n";
    }
  }
}

void print_junctions(std::ostream& out, const char* which, const JunctionScore& score) {
  out << "  junctions within 2.5 m, by 4 px, " << which << ":";
  for (const auto type : {JunctionType::x, JunctionType::t, JunctionType::l}) {
    const auto& c = score[static_cast<std::size_t>(type)];
    const double none = std::numeric_limits<double>::quiet_NaN();
    out << "  " << to_string(type) << " precision " << in_percent(c.right + c.wrong > 0 ? c.precision() : none) << " ("
        << c.right << " of " << c.right + c.wrong << "), recall " << in_percent(c.to_find > 0 ? c.recall() : none)
        << " (" << c.found << " of " << c.to_find << ")";
  }
  out << "\n";
}

std::string yaw_words(const DataSet& set, const EvaluateOptions& options) {
  const auto with_yaw = std::count_if(set.frames.begin(), set.frames.end(), [](const auto& f) { return f.has_yaw; });
  if (with_yaw == 0) return "no yaw";
  if (!options.use_yaw) return "yaw not used";
  if (with_yaw == static_cast<std::ptrdiff_t>(set.frames.size())) return "yaw given";
  return "yaw given for " + std::to_string(with_yaw) + " of them";
}

}  // namespace

const char* to_string(LocModel model) { return model == LocModel::paper ? "paper" : "full"; }
const char* to_string(Landmarks landmarks) {
  if (landmarks == Landmarks::goalposts) return "goalposts";
  return landmarks == Landmarks::both ? "both" : "lines";
}

std::string json_line(const std::string& set, const FrameRecord& record) {
  const auto& e = record.estimate;
  json out;
  out["set"] = set;
  out["image"] = record.frame.image;
  out["t_s"] = record.frame.has_time ? json(record.frame.time_s) : json(nullptr);
  if (!record.failure.empty()) {
    out["failure"] = record.failure;
    return in_utf8(out);
  }
  out["pose"] = e.valid ? pose_json(e.pose) : json(nullptr);
  out["std"] = e.valid ? std_json(e.covariance) : json(nullptr);
  out["confidence"] = e.valid ? share(e.confidence) : json(0.0);
  out["mirror"] = mirror_json(e);
  out["junctions"] = junctions_json(record.junctions);
  out["posts"] = posts_json(record.posts);
  out["us"] = times_json(record.us);
  out["shows"] = record.shows;
  out["settled"] = record.settled;
  if (record.error) out["error"] = error_json(*record.error);
  return in_utf8(out);
}

std::string json_summary(const std::vector<SetResult>& sets, const EvaluateOptions& options) {
  std::vector<const FrameRecord*> all;
  json per_set = json::array();
  const auto has_yaw = [](const FrameRecord* record) { return record->frame.has_yaw; };
  for (const auto& set : sets) {
    for (const auto& record : set.frames) all.push_back(&record);
    json entry = {{"name", set.name}, {"protocol", to_string(set.protocol)}};
    entry.update(figures(summarize(set)));
    if (set.sequence) entry["sequence"] = sequence_json(*set.sequence);
    per_set.push_back(entry);
  }
  json summary = {{"model", to_string(options.chain.model)},
                  {"landmarks", to_string(options.chain.landmarks)},
                  {"work", std::to_string(options.chain.work_width) + "x" + std::to_string(options.chain.work_height)},
                  {"yaw", options.use_yaw && std::any_of(all.begin(), all.end(), has_yaw)},
                  {"seed", options.seed}};
  summary.update(figures(summarize(all)));
  summary["sets"] = per_set;
  return in_utf8(json{{"summary", summary}});
}

void print_table_head(std::ostream& out, const DataSet& set, const EvaluateOptions& options) {
  out << set.name << ": " << set.frames.size() << " frames, " << to_string(set.protocol) << ", field " << set.field_name
      << "; " << to_string(options.chain.model) << " model, landmarks: " << to_string(options.chain.landmarks) << ", "
      << yaw_words(set, options) << ", " << options.chain.work_width << "x" << options.chain.work_height << "\n";
  out << "  image                     x m     y m   theta   std m  conf  shown   error m    deg\n";
}

void print_table_row(std::ostream& out, const FrameRecord& record) {
  const auto& e = record.estimate;
  out << "  " << std::left << std::setw(20) << record.frame.image << std::right;
  if (!record.failure.empty()) {
    out << " could not be used\n";
    return;
  }
  if (e.valid) {
    print(out, " %7.3f %7.3f %7.1f %7.3f %5.2f %4d%s", number(e.pose.x), number(e.pose.y),
          number(degrees(e.pose.theta)), number(std::sqrt(e.covariance.xx + e.covariance.yy)), number(e.confidence),
          record.shows, record.settled ? " " : "+");
  } else {
    print(out, " no pose%*d ", 34, record.shows);
  }
  if (record.error && record.error->has_pose) {
    print(out, "  %8.3f %6.2f%s%s", record.error->distance_m, record.error->angle_deg,
          record.error->wrong_half ? "  wrong half" : "", record.error->outside_3_sigma ? "  outside 3 sigma" : "");
  }
  out << "\n";
}

void print_table_summary(std::ostream& out, const SetResult& set) {
  const Summary s = summarize(set);
  print(out, "  poses: %d of %d frames; shown %.1f times on average, %d at most (+: not settled, %d frames)\n",
        s.with_pose, s.frames, s.mean_shows, s.most_shows, s.not_settled);
  if (s.failed > 0)
    print(out, "  could not be used: %d of %d frames, which are in no figure here\n", s.failed, s.frames);
  if (s.failed == s.frames) {
    out << "\n";
    return;
  }
  if (s.with_truth > 0) print_errors(out, s);
  if (set.sequence) print_sequence(out, *set.sequence);
  if (s.has_junctions) {
    print_junctions(out, "vision alone", s.seen_junctions);
    print_junctions(out, "as reported", s.junctions);
  }
  out << "  median us:";
  for (std::size_t i = 0; i < stage_count; ++i) {
    if (s.median_us[i] > 0.0) print(out, " %s %.0f", to_string(static_cast<Stage>(i)), s.median_us[i]);
  }
  out << "\n\n";
}

}  // namespace touchline::host
