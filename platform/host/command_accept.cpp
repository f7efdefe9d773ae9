// SPDX-License-Identifier: Apache-2.0
// `touchline accept`.
#include <filesystem>
#include <fstream>
#include <ostream>

#include "platform/host/accept.h"
#include "platform/host/command_line.h"
#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

/// The file stays as it is.
void check_can_be_written(const std::filesystem::path& file) {
  const bool is_new = !std::filesystem::exists(file);
  if (!std::ofstream(file, std::ios::app)) throw HostError(file.string() + ": cannot be written; check the folder");
  if (is_new) std::filesystem::remove(file);
}

}  // namespace

int run_accept(const AcceptCommand& command, std::ostream& out, std::ostream& err) {
  if (command.folder.empty() && !command.simulator)
    throw HostError("accept --no-simulator: nothing is left to judge; give the folder that holds the data sets");
  if (!command.folder.empty() && !std::filesystem::is_directory(command.folder)) {
    throw HostError(command.folder +
                    ": no such folder; give the folder that holds render-table2 and the other data sets");
  }
  // What would fail at the end of the runs is found before them.
  if (!command.figures.empty() && !command.rewrite) check_figures_file(command.figures);
  if (command.rewrite) check_can_be_written(command.figures);
  if (!command.output.empty()) check_can_be_written(command.output);
  const Progress progress = [&err](const std::string& what) { err << what << "\n" << std::flush; };
  Figures figures;
  if (!command.folder.empty()) figures = accept_data_sets(command.folder, progress);
  if (command.simulator) {
    const Figures more = accept_simulator(command.runs, progress);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  print_figures(out, figures);
  if (!command.output.empty()) write_figures(command.output, figures);
  if (command.figures.empty()) return all_musts_met(figures) ? exit_ok : exit_missed;
  if (command.rewrite) {
    write_figures(command.figures, figures);
    out << "written: " << command.figures << "\n";
    return exit_ok;
  }
  const auto worse = worse_than_file(command.figures, figures, out);
  for (const auto& sentence : worse) out << "WORSE than " << command.figures << ": " << sentence << "\n";
  if (worse.empty()) out << "no figure is worse than in " << command.figures << "\n";
  return worse.empty() ? exit_ok : exit_missed;
}

}  // namespace touchline::host
