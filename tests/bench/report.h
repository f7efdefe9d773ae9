// SPDX-License-Identifier: Apache-2.0
// Medians with spread, and the tables for people and programs.
#pragma once

#include <string>
#include <vector>

namespace touchline::bench {

struct Spread {
  double low = 0.0, median = 0.0, high = 0.0;  // 10 %, 50 %, 90 %
};
Spread spread_of(std::vector<double> samples);

struct PairedRow {
  std::string stage;
  Spread ours_us, opencv_us, ratio;  // ratio: of the pairs, not of the medians
  std::string note;
};
PairedRow paired_row(const std::string& stage, const std::vector<double>& ours, const std::vector<double>& opencv,
                     const std::string& note = "");

struct AgreementRow {
  std::string what;
  Spread iou;
  std::string note;
};

struct FigureRow {
  std::string what;
  double us = 0.0;
  double memcpys = 0.0;  // as a multiple of the yardstick; 0: not given
  std::string note;
};

void print_paired(const std::vector<PairedRow>& rows);
void print_agreement(const std::vector<AgreementRow>& rows);
void print_figures(const char* title, const std::vector<FigureRow>& rows);
/// [{"stage", "ours_us", "opencv_us", "ratio"}], medians. False when the file cannot be written.
bool write_json(const std::string& path, const std::vector<PairedRow>& rows);

}  // namespace touchline::bench
