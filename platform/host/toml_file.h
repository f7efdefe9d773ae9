// SPDX-License-Identifier: Apache-2.0
// A TOML file as a JSON value, so that one set of checked readers serves dataset.toml, the robot's file and the lines
// of frames.jsonl. Keeps the large TOML header in one source file.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace touchline::host {

/// The line of each key, by "table.key".
using TomlLines = std::map<std::string, int>;

/// Throws HostError: the file is missing (then with `remedy`), a folder, or broken (with its line). Dates and
/// times become binary values (their text), which no reader takes for a string; NaN and infinity stay numbers.
nlohmann::json read_toml(const std::filesystem::path& path, const std::string& remedy, TomlLines& lines);

}  // namespace touchline::host
