// SPDX-License-Identifier: Apache-2.0
// Runs the fixture sequences through the whole chain, both models, and writes down a hash of every product and the pose
// of every frame. The text is under version control: a change of behaviour shows as a diff of it.
//   golden_outputs --check EXPECTED FIXTURES    status 1 and the first lines that differ, where one differs
//   golden_outputs --write EXPECTED FIXTURES    writes EXPECTED/NAME.txt for each data set FIXTURES/NAME
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "platform/host/chain.h"
#include "platform/host/dataset.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "tests/golden/product_hashes.h"

namespace {

using namespace touchline;
namespace fs = std::filesystem;

constexpr std::uint64_t seed = 1;
constexpr int shows = 4;  // of an independent frame, enough for a pose to form

std::string format(const char* pattern, auto... values) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Decimals for people; the hash has the bits.
std::string describe(const PoseEstimate& estimate) {
  const std::string hash = format("%016llx", static_cast<unsigned long long>(test::hash_estimate(estimate)));
  if (!estimate.valid) return hash + "  none";
  return hash + format("  x %.4f m, y %.4f m, theta %.3f deg, confidence %.3f", static_cast<double>(estimate.pose.x),
                       static_cast<double>(estimate.pose.y), static_cast<double>(degrees(estimate.pose.theta)),
                       static_cast<double>(estimate.confidence));
}

struct ModelRun {
  const char* name;
  host::Chain chain;
  PoseEstimate estimate;

  ModelRun(const char* run_name, LocModel model, const FieldDimensions& field)
      : name(run_name), chain({.model = model, .landmarks = Landmarks::both}, field) {}
};

void step(ModelRun& run, const host::DataSet& set, const host::DataFrame& frame, const FrameView& image) {
  const bool fresh = set.protocol == host::Protocol::independent;
  if (fresh) run.chain.forget(seed);
  run.chain.see(image, frame.time_s, frame.camera, frame.odometry, nullptr);
  for (int i = 0; i < (fresh ? shows : 1); ++i) {
    LocalizerInput input;
    input.time_s = frame.time_s + 0.02 * i;
    if (!fresh) input.odometry = frame.odometry;
    input.has_yaw = frame.has_yaw;
    input.yaw = frame.yaw;
    run.estimate = run.chain.locate(input, nullptr);
  }
}

std::string golden_text(const host::DataSet& set) {
  std::ostringstream text;
  ModelRun full("full", LocModel::full, set.field);
  ModelRun paper("paper", LocModel::paper, set.field);
  full.chain.forget(seed);
  paper.chain.forget(seed);
  for (const host::DataFrame& frame : set.frames) {
    const host::RgbImage image = host::read_frame_image(frame);
    step(full, set, frame, image.view());
    step(paper, set, frame, image.view());
    for (const test::ProductHash& product : test::hash_products(full.chain.vision())) {
      text << frame.image << format(" %-12s %016llx\n", product.name, static_cast<unsigned long long>(product.hash));
    }
    for (const ModelRun* run : {&full, &paper}) {
      text << frame.image << format(" pose %-7s ", run->name) << describe(run->estimate) << '\n';
    }
  }
  return text.str();
}

std::string read_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Prints the first lines that differ; true when none does.
bool same(const fs::path& path, const std::string& expected, const std::string& found) {
  std::istringstream expected_lines(expected);
  std::istringstream found_lines(found);
  int shown = 0;
  for (int line = 1; shown < 12; ++line) {
    std::string a;
    std::string b;
    std::getline(expected_lines, a);
    std::getline(found_lines, b);
    if (!expected_lines && !found_lines) break;
    if (a == b) continue;
    std::printf("%s:%d\n  expected %s\n  found    %s\n", path.c_str(), line, a.c_str(), b.c_str());
    ++shown;
  }
  return shown == 0;
}

std::vector<fs::path> data_sets(const fs::path& fixtures) {
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(fixtures)) {
    if (fs::exists(entry.path() / "frames.jsonl")) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

int run(const std::string& mode, const fs::path& expected, const fs::path& fixtures) {
  const std::vector<fs::path> folders = data_sets(fixtures);
  if (folders.empty()) throw host::HostError(fixtures.string() + ": no data set in this folder");
  bool all_same = true;
  for (const fs::path& folder : folders) {
    const std::string text = golden_text(host::read_dataset(folder));
    const fs::path path = expected / (folder.filename().string() + ".txt");
    if (mode == "--write") {
      fs::create_directories(expected);
      std::ofstream(path, std::ios::binary) << text;
    } else {
      all_same = same(path, read_text(path), text) && all_same;
    }
  }
  if (!all_same) std::puts("The outputs changed. Where this is meant: make golden, and say why in the commit.");
  return all_same ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() != 3 || (arguments[0] != "--check" && arguments[0] != "--write")) {
    std::fputs("usage: golden_outputs --check|--write EXPECTED FIXTURES\n", stderr);
    return 2;
  }
  try {
    return run(arguments[0], arguments[1], arguments[2]);
  } catch (const host::HostError& error) {
    std::fprintf(stderr, "golden_outputs: %s\n", error.what());
    return 2;
  }
}
