// SPDX-License-Identifier: Apache-2.0
// A TOML file as a JSON value, so that one set of checked readers serves dataset.toml and the lines of frames.jsonl.
// Keeps the large TOML header in one source file.
#pragma once

#include <filesystem>

#include <nlohmann/json_fwd.hpp>

namespace touchline::host {

/// Throws HostError: the file is missing, or broken (with its line). Dates become strings; NaN and infinity stay
/// numbers.
nlohmann::json read_toml(const std::filesystem::path& path);

}  // namespace touchline::host
