// SPDX-License-Identifier: Apache-2.0
// `touchline evaluate`, and the run of one data set that it shares with `touchline locate`.
#include <algorithm>
#include <ostream>
#include <set>
#include <utility>

#include "platform/host/command_line.h"
#include "platform/host/frame_pictures.h"
#include "platform/host/report.h"
#include "platform/host/run_set.h"

namespace touchline::host {
namespace {

/// Sets of one name, or of one folder for their pictures, become "walk", "walk-2", and so on.
void name_apart(std::vector<DataSet>& sets) {
  std::set<std::string> used;
  for (auto& set : sets) {
    const std::string name = set.name;
    for (int number = 2; !used.insert(folder_name(set.name)).second; ++number) {
      set.name = name + "-" + std::to_string(number);
    }
  }
}

}  // namespace

void print_warnings(const DataSet& set, std::ostream& err) {
  for (const auto& sentence : set.warnings) err << "touchline: note: " << sentence << "\n";
}

SetResult run_set(const DataSet& set, const EvaluateOptions& options, bool json, std::ostream& out, std::ostream& err) {
  bool headed = json;  // with the first frame: what concerns all frames is an error by itself
  const auto print_head = [&] {
    if (!std::exchange(headed, true)) print_table_head(out, set, options);
  };
  SetResult result = evaluate(set, options, [&](const FrameRecord& record) {
    print_head();
    if (json) {
      out << json_line(set.name, record) << "\n" << std::flush;
    } else {
      print_table_row(out, record);
    }
    if (!record.failure.empty()) {
      out << std::flush;
      err << "touchline: " << record.failure << "\n";
    }
  });
  print_head();
  if (!json) print_table_summary(out, result);
  const Summary sum = summarize(result);
  if (sum.with_pose == 0 && sum.failed < sum.frames) {
    out << std::flush;
    err << "touchline: note: " << set.name
        << ": no frame has a pose; check the lens ([camera] model, focal_px, cx, cy), [mount] height_m and pitch_deg, "
           "and field; --frames OUT draws what was seen\n";
  }
  return result;
}

int exit_status(const std::vector<SetResult>& results) {
  for (const auto& result : results) {
    const auto failed = [](const FrameRecord& record) { return !record.failure.empty(); };
    if (std::any_of(result.frames.begin(), result.frames.end(), failed)) return exit_bad_input;
  }
  return exit_ok;
}

int run_evaluate(const EvaluateCommand& command, std::ostream& out, std::ostream& err) {
  std::vector<DataSet> sets;  // all are read before the first frame: a mistake shows at once
  sets.reserve(command.folders.size());
  for (const auto& folder : command.folders) {
    sets.push_back(read_dataset(folder));
    print_warnings(sets.back(), err);
  }
  name_apart(sets);
  refuse_to_overwrite(sets, command.options.frames_out);
  std::vector<SetResult> results;
  results.reserve(sets.size());
  for (const auto& set : sets) results.push_back(run_set(set, command.options, command.json, out, err));
  if (command.json) out << json_summary(results, command.options) << "\n";
  return exit_status(results);
}

}  // namespace touchline::host
