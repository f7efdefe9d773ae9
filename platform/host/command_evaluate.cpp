// SPDX-License-Identifier: Apache-2.0
// `touchline evaluate` and `touchline locate`.
#include <ostream>

#include "platform/host/command_line.h"
#include "platform/host/report.h"

namespace touchline::host {
namespace {

void print_warnings(const DataSet& set, std::ostream& err) {
  for (const auto& sentence : set.warnings) err << "touchline: note: " << sentence << "\n";
}

SetResult run_set(const DataSet& set, const EvaluateOptions& options, bool json, std::ostream& out) {
  if (!json) print_table_head(out, set, options);
  SetResult result = evaluate(set, options, [&](const FrameRecord& record) {
    if (json) {
      out << json_line(record) << "\n" << std::flush;
    } else {
      print_table_row(out, record);
    }
  });
  if (!json) print_table_summary(out, result);
  return result;
}

}  // namespace

int run_evaluate(const EvaluateCommand& command, std::ostream& out, std::ostream& err) {
  std::vector<DataSet> sets;  // all are read before the first frame: a mistake shows at once
  sets.reserve(command.folders.size());
  for (const auto& folder : command.folders) {
    sets.push_back(read_dataset(folder));
    print_warnings(sets.back(), err);
  }
  std::vector<SetResult> results;
  results.reserve(sets.size());
  for (const auto& set : sets) results.push_back(run_set(set, command.options, command.json, out));
  if (command.json) out << json_summary(results, command.options) << "\n";
  return exit_ok;
}

int run_locate(const LocateCommand& command, std::ostream& out, std::ostream& err) {
  const std::filesystem::path camera(command.camera);
  DataSet set = read_dataset_toml(std::filesystem::is_directory(camera) ? camera / "dataset.toml" : camera);
  print_warnings(set, err);
  set.protocol = Protocol::independent;
  for (const auto& image : command.images) {
    DataFrame frame;
    frame.image = image;
    frame.path = image;
    frame.camera = set.camera;
    set.frames.push_back(frame);
  }
  const SetResult result = run_set(set, command.options, command.json, out);
  if (command.json) out << json_summary({result}, command.options) << "\n";
  return exit_ok;
}

}  // namespace touchline::host
