// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/report.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

namespace touchline::bench {

Spread spread_of(std::vector<double> samples) {
  if (samples.empty()) return {};
  std::sort(samples.begin(), samples.end());
  const auto at = [&](double share) {
    return samples[static_cast<std::size_t>(share * static_cast<double>(samples.size() - 1) + 0.5)];
  };
  return {at(0.1), at(0.5), at(0.9)};
}

PairedRow paired_row(const std::string& stage, const std::vector<double>& ours, const std::vector<double>& opencv,
                     const std::string& note) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(ours.size(), opencv.size()); ++i)
    ratios.push_back(opencv[i] / std::max(ours[i], 1e-3));
  return {stage, spread_of(ours), spread_of(opencv), spread_of(ratios), note};
}

void print_paired(const std::vector<PairedRow>& rows) {
  std::puts("\n| stage | ours, us (10..90 %) | OpenCV, us (10..90 %) | times faster (10..90 % of the pairs) | |");
  std::puts("|---|---|---|---|---|");
  for (const PairedRow& r : rows) {
    std::printf("| %s | %.1f (%.1f..%.1f) | %.0f (%.0f..%.0f) | %.1f (%.1f..%.1f) | %s |\n", r.stage.c_str(),
                r.ours_us.median, r.ours_us.low, r.ours_us.high, r.opencv_us.median, r.opencv_us.low, r.opencv_us.high,
                r.ratio.median, r.ratio.low, r.ratio.high, r.note.c_str());
  }
}

void print_agreement(const std::vector<AgreementRow>& rows) {
  std::puts("\n| product | agreement (10..90 % of the frames) | |\n|---|---|---|");
  for (const AgreementRow& r : rows) {
    std::printf("| %s | %.3f (%.3f..%.3f) | %s |\n", r.what.c_str(), r.iou.median, r.iou.low, r.iou.high,
                r.note.c_str());
  }
}

void print_figures(const char* title, const std::vector<FigureRow>& rows) {
  std::printf("\n| %s | us | times memcpy | |\n|---|---|---|---|\n", title);
  for (const FigureRow& r : rows) {
    std::printf("| %s | %.1f | ", r.what.c_str(), r.us);
    if (r.memcpys > 0.0) std::printf("%.2f", r.memcpys);
    std::printf(" | %s |\n", r.note.c_str());
  }
}

bool write_json(const std::string& path, const std::vector<PairedRow>& rows) {
  std::ofstream file(path);
  file << "[\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "  {\"stage\": \"%s\", \"ours_us\": %.3f, \"opencv_us\": %.3f, \"ratio\": %.3f}%s\n",
                  rows[i].stage.c_str(), rows[i].ours_us.median, rows[i].opencv_us.median, rows[i].ratio.median,
                  i + 1 < rows.size() ? "," : "");
    file << text;
  }
  file << "]\n";
  file.close();
  return static_cast<bool>(file);
}

}  // namespace touchline::bench
