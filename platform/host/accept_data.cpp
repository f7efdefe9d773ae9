// SPDX-License-Identifier: Apache-2.0
// The acceptance figures of the data sets.
#include <cmath>
#include <limits>

#include "platform/host/accept.h"
#include "platform/host/evaluate.h"
#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

Figure share(const std::string& name, int part, int whole, std::optional<double> must, std::optional<double> aim) {
  const double value = whole > 0 ? 100.0 * part / whole : 0.0;
  return {name, value, false, must, aim, "%"};
}
Figure size(const std::string& name, double value, const char* unit, std::optional<double> must,
            std::optional<double> aim) {
  return {name, std::isnan(value) ? infinite : value, true, must, aim, unit};
}
Figure wrong_half(const std::string& set, const Summary& s) {
  return size(set + ": wrong half", s.wrong_half, "", 0.0, 0.0);
}

/// The frames of the full model at the default size, gathered for the figures over all sets.
struct Gathered {
  JunctionScore seen_junctions{};
  JunctionScore junctions{};
  bool has_junctions = false;
  int outside = 0;
  int frames = 0;

  void add(const Summary& s) {
    seen_junctions += s.seen_junctions;
    junctions += s.junctions;
    has_junctions = has_junctions || s.has_junctions;
    outside += s.outside_3_sigma;
    frames += s.with_truth;
  }
};

SetResult run(const DataSet& set, LocModel model, Landmarks landmarks) {
  EvaluateOptions options;
  options.chain.model = model;
  options.chain.landmarks = landmarks;
  return evaluate(set, options, [](const FrameRecord& record) {  // no figure over fewer frames than are told
    if (!record.failure.empty()) throw HostError(record.failure);
  });
}

void table2_figures(const DataSet& set, Figures& out, Gathered& all) {
  const Summary full = summarize(run(set, LocModel::full, Landmarks::lines));
  all.add(full);
  const int n = full.with_truth;
  const std::string name = "render-table2, full";
  out.push_back(share(name + ": within 0.40 m", full.within(0.40), n, 100.0, 100.0));
  out.push_back(share(name + ": within 0.10 m", full.within(0.10), n, 90.0, std::nullopt));
  out.push_back(share(name + ": within 0.05 m", full.within(0.05), n, std::nullopt, 100.0));
  out.push_back(wrong_half(name, full));
  out.push_back(size(name + ": median distance", full.median_m(), "m", std::nullopt, 0.01));
  out.push_back(size(name + ": median angle", full.median_deg(), "deg", std::nullopt, 0.3));
  const Summary paper = summarize(run(set, LocModel::paper, Landmarks::lines));
  out.push_back(share("render-table2, paper: within 0.40 m", paper.within(0.40), n, 85.0, 100.0));
  const Summary posts = summarize(run(set, LocModel::paper, Landmarks::goalposts));
  out.push_back(share("render-table2, paper, goal posts: within 0.40 m", posts.within(0.40), n, 40.0, 100.0));
}

void hard_figures(const DataSet& set, Figures& out, Gathered& all) {
  const Summary s = summarize(run(set, LocModel::full, Landmarks::lines));
  all.add(s);
  out.push_back(share("render-hard: within 0.20 m", s.within(0.20), s.with_truth, 90.0, std::nullopt));
  out.push_back(share("render-hard: within 0.10 m", s.within(0.10), s.with_truth, std::nullopt, 100.0));
  out.push_back(wrong_half("render-hard", s));
  out.push_back(size("render-hard: median distance", s.median_m(), "m", std::nullopt, 0.03));
}

void walk_figures(const DataSet& set, Figures& out, Gathered& all) {
  const SetResult result = run(set, LocModel::full, Landmarks::lines);
  all.add(summarize(result));
  if (!result.sequence) return;
  const SequenceScore& score = *result.sequence;
  out.push_back(size("render-walk: RMSE", score.rmse_m, "m", 0.10, 0.02));
  out.push_back(size("render-walk: RMSE of the angle", score.rmse_deg, "deg", 3.0, 0.5));
  out.push_back(size("render-walk: frames without a pose", score.without_pose, "", 0.0, 0.0));
  double slowest = 0.0;
  for (const auto& seconds : score.back_s) slowest = std::max(slowest, seconds.value_or(infinite));
  out.push_back(size("render-walk: back after a kidnap", slowest, "s", 1.0, 0.5));
}

void kidsize_figures(const DataSet& set, Figures& out, Gathered& all) {
  const Summary s = summarize(run(set, LocModel::full, Landmarks::lines));
  all.add(s);
  out.push_back(
      share("real-kidsize: within 0.30 m, 4 deg", s.within(0.30, 4.0), s.with_truth, 200.0 / 3.0, std::nullopt));
  out.push_back(share("real-kidsize: within 0.10 m, 2 deg", s.within(0.10, 2.0), s.with_truth, std::nullopt, 100.0));
}

void junction_figures(const JunctionScore& score, const std::string& which, Figures& out) {
  for (const auto type : {JunctionType::x, JunctionType::t, JunctionType::l}) {
    const JunctionCount& c = score[static_cast<std::size_t>(type)];
    const std::string name = "junctions " + std::string(touchline::to_string(type)) + which;
    out.push_back(share(name + ": precision", c.right, c.right + c.wrong, 85.0, 95.0));
    out.push_back(share(name + ": recall", c.found, c.to_find, 70.0, 90.0));
  }
}

void gathered_figures(const Gathered& all, Figures& out) {
  if (all.has_junctions) {
    junction_figures(all.junctions, "", out);
    junction_figures(all.seen_junctions, ", vision alone", out);
  }
  if (all.frames > 0) {
    out.push_back(size("truth outside 3 sigma, data sets", 100.0 * all.outside / all.frames, "%", std::nullopt, 2.0));
  }
}

}  // namespace

Figures accept_data_sets(const std::filesystem::path& folder, const Progress& progress) {
  using Row = void (*)(const DataSet&, Figures&, Gathered&);
  const std::pair<const char*, Row> rows[] = {{"render-table2", table2_figures},
                                              {"render-hard", hard_figures},
                                              {"render-walk", walk_figures},
                                              {"real-kidsize", kidsize_figures}};
  std::string looked_for;
  bool found = false;
  for (const auto& [name, row] : rows) {
    looked_for += (looked_for.empty() ? "" : ", ") + std::string(name);
    found = found || std::filesystem::exists(folder / name);
  }
  if (!found) throw HostError(folder.string() + ": holds none of the data sets that are judged: " + looked_for);
  Figures figures;
  Gathered all;
  for (const auto& [name, row] : rows) {
    if (!std::filesystem::exists(folder / name)) {
      progress(std::string(name) + ": not there, left out");
      continue;
    }
    progress(name);
    row(read_dataset(folder / name), figures, all);
  }
  gathered_figures(all, figures);
  return figures;
}

}  // namespace touchline::host
