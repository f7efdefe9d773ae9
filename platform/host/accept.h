// SPDX-License-Identifier: Apache-2.0
// The runs behind the acceptance figures: the data sets of a folder, and the simulator.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "platform/host/figures.h"

namespace touchline::host {

/// Told what is being run, for people who wait.
using Progress = std::function<void(const std::string&)>;

/// render-table2, render-hard, render-walk and real-kidsize, as far as they are in the folder.
Figures accept_data_sets(const std::filesystem::path& folder, const Progress& progress);

struct SimulatorRuns {
  int poses = 1000;  // on acyut-5x3
  int walks = 20;    // on small-2026 and on middle-2026 each
  double walk_s = 60.0;
  int threads = 2;
};
Figures accept_simulator(const SimulatorRuns& runs, const Progress& progress);

}  // namespace touchline::host
