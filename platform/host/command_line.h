// SPDX-License-Identifier: Apache-2.0
// The commands of `touchline`, apart from the parsing of their arguments.
// Exit status: 0 done; 1 the run worked but a figure or a check missed its mark; 2 bad input or bad usage.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "platform/host/accept.h"
#include "platform/host/evaluate.h"

namespace touchline::host {

inline constexpr int exit_ok = 0;
inline constexpr int exit_missed = 1;
inline constexpr int exit_bad_input = 2;

struct EvaluateCommand {
  std::vector<std::string> folders;
  bool json = false;
  EvaluateOptions options;
};
int run_evaluate(const EvaluateCommand& command, std::ostream& out, std::ostream& err);

struct LocateCommand {
  std::string camera;  // a dataset.toml, or its folder
  std::vector<std::string> images;
  std::optional<double> yaw_deg;  // as imu_yaw_deg of frames.jsonl; these four come before what files say
  std::optional<double> height_m;
  std::optional<double> pitch_deg;
  std::optional<double> roll_deg;
  bool json = false;
  EvaluateOptions options;
};
int run_locate(const LocateCommand& command, std::ostream& out, std::ostream& err);

struct AcceptCommand {
  std::string folder;
  std::string figures;  // the file to be held against; empty: the musts decide
  std::string output;   // where the figures of this run are written; empty: nowhere
  bool rewrite = false;
  bool simulator = true;
  SimulatorRuns runs;
};
int run_accept(const AcceptCommand& command, std::ostream& out, std::ostream& err);

/// Prints what the state of the chain takes, struct by struct.
int run_memory(std::ostream& out);

/// Parses the arguments, runs the command, and turns every error into one line on `err` and status 2. `terminal`: `out`
/// is one, and a line may be written over.
int touchline_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err, bool terminal = false);

}  // namespace touchline::host
