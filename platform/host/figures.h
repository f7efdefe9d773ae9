// SPDX-License-Identifier: Apache-2.0
// The acceptance figures: each beside what it must be and what it aims at, and the file of figures under version
// control that no change may make worse.
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

namespace touchline::host {

struct Figure {
  std::string name;
  double value = 0.0;
  bool smaller_is_better = true;
  std::optional<double> must;
  std::optional<double> aim;
  std::string unit;  // "m", "deg", "s", "" for a count, "%" for a share (the value is then 0..100)
};

using Figures = std::vector<Figure>;

/// One line a figure: value, must, aim, and what was missed.
void print_figures(std::ostream& out, const Figures& figures);
[[nodiscard]] bool all_musts_met(const Figures& figures);

/// {"figures": {name: value}}, values rounded to 6 decimals; null for infinity. Throws HostError.
void write_figures(const std::filesystem::path& file, const Figures& figures);
/// Throws HostError for a missing or broken file of figures.
void check_figures_file(const std::filesystem::path& file);
/// Figures that the file does not know stay out of it; those that only the file knows are told on `out` as not run.
/// Returns the sentences about figures that are worse than in the file. Throws as the above.
std::vector<std::string> worse_than_file(const std::filesystem::path& file, const Figures& figures, std::ostream& out);

}  // namespace touchline::host
