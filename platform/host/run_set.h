// SPDX-License-Identifier: Apache-2.0
// The run of one data set as `touchline evaluate` and `touchline locate` show it.
#pragma once

#include <iosfwd>
#include <vector>

#include "platform/host/evaluate.h"

namespace touchline::host {

void print_warnings(const DataSet& set, std::ostream& err);
/// Frames go to `out` as a table or as JSON lines; frames that could not be used, and hints, to `err`.
SetResult run_set(const DataSet& set, const EvaluateOptions& options, bool json, std::ostream& out, std::ostream& err);
/// Bad input when any frame could not be used.
int exit_status(const std::vector<SetResult>& results);

}  // namespace touchline::host
