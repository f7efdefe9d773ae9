// SPDX-License-Identifier: Apache-2.0
// The acceptance figures and their file.
#include "platform/host/figures.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <ostream>

#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

using json = nlohmann::ordered_json;

/// The runs are deterministic: this only takes up the rounding of the file.
constexpr double rounding = 1e-6;

bool reaches(const Figure& figure, double mark) {
  return figure.smaller_is_better ? figure.value <= mark + rounding : figure.value >= mark - rounding;
}

std::string shown(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "none";
  char text[40];
  std::snprintf(text, sizeof text, unit == "m" ? "%.3f %s" : unit.empty() ? "%.0f%s" : "%.2f %s", value, unit.c_str());
  return text;
}
std::string shown(const Figure& figure, const std::optional<double>& mark) {
  if (!mark) return "-";
  return (figure.smaller_is_better ? "<= " : ">= ") + shown(*mark, figure.unit);
}

const char* verdict(const Figure& figure) {
  if (figure.must && !reaches(figure, *figure.must)) return "MUST MISSED";
  if (figure.aim && !reaches(figure, *figure.aim)) return "aim missed";
  return figure.must || figure.aim ? "met" : "";
}

json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e6) / 1e6;
}

json read_figures(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw HostError(file.string() + ": no such file; write it with --rewrite first");
  try {
    json values = json::parse(in).at("figures");
    if (values.is_object()) return values;
  } catch (const json::exception& error) {
    throw HostError(file.string() + ": not a file of figures: " + error.what() + "; write it anew with --rewrite");
  }
  throw HostError(file.string() + ": not a file of figures: figures is no table; write it anew with --rewrite");
}

}  // namespace

void print_figures(std::ostream& out, const Figures& figures) {
  std::size_t width = 6;
  for (const auto& figure : figures) width = std::max(width, figure.name.size());
  char text[400];
  std::snprintf(text, sizeof text, "%-*s %11s %12s %12s\n", static_cast<int>(width), "figure", "value", "must", "aim");
  out << text;
  for (const auto& figure : figures) {
    std::snprintf(text, sizeof text, "%-*s %11s %12s %12s  %s\n", static_cast<int>(width), figure.name.c_str(),
                  shown(figure.value, figure.unit).c_str(), shown(figure, figure.must).c_str(),
                  shown(figure, figure.aim).c_str(), verdict(figure));
    out << text;
  }
}

bool all_musts_met(const Figures& figures) {
  return std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return !f.must || reaches(f, *f.must); });
}

void write_figures(const std::filesystem::path& file, const Figures& figures) {
  json values = json::object();
  for (const auto& figure : figures) values[figure.name] = rounded(figure.value);
  std::ofstream out(file);
  out << json{{"figures", values}}.dump(2) << "\n";
  if (!out.flush()) throw HostError(file.string() + ": cannot be written; check the folder and the space left");
}

void check_figures_file(const std::filesystem::path& file) { (void)read_figures(file); }

std::vector<std::string> worse_than_file(const std::filesystem::path& file, const Figures& figures, std::ostream& out) {
  const json values = read_figures(file);
  std::vector<std::string> worse;
  for (const auto& [name, old] : values.items()) {
    const auto same = [&key = name](const Figure& f) { return f.name == key; };
    const auto found = std::find_if(figures.begin(), figures.end(), same);
    if (found == figures.end()) {
      out << "not run: " << name << "\n";
      continue;
    }
    if (!old.is_number()) continue;  // there was no figure to keep
    if (!reaches(*found, old.get<double>())) {
      worse.push_back(name + ": " + shown(found->value, found->unit) + ", was " +
                      shown(old.get<double>(), found->unit));
    }
  }
  return worse;
}

}  // namespace touchline::host
