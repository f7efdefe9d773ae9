// SPDX-License-Identifier: Apache-2.0
// What an evaluation says: a table for people, JSON lines for programs.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "platform/host/evaluate.h"

namespace touchline::host {

/// One line of JSON without its line end:
/// {"set", "image", "t_s", "pose": {"x_m","y_m","theta_deg"}, "std": {...}, "confidence", "mirror": {...}, "junctions":
/// [{"type","u_px","v_px","x_m","y_m","confidence"}], "posts": [...], "us": {stage: microseconds}, "shows", "settled"},
/// and "error" {"m","deg","wrong_half","outside_3_sigma"} where there is a truth. u, v in pixels of the camera's image;
/// x, y of junctions and posts in the robot's frame. pose, std and mirror are null where there is none. A frame that
/// could not be used has {"set", "image", "t_s", "failure"} alone.
std::string json_line(const std::string& set, const FrameRecord& record);
/// {"summary": {figures of all frames together, "sets": [figures of each set]}}
std::string json_summary(const std::vector<SetResult>& sets, const EvaluateOptions& options);

void print_table_head(std::ostream& out, const DataSet& set, const EvaluateOptions& options);
void print_table_row(std::ostream& out, const FrameRecord& record);
void print_table_summary(std::ostream& out, const SetResult& set);

const char* to_string(LocModel model);
const char* to_string(Landmarks landmarks);

}  // namespace touchline::host
