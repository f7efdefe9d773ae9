// SPDX-License-Identifier: Apache-2.0
// The benchmark: paired with OpenCV, then by size. Fails on no figure.
//   touchline_bench [--data FOLDER] [--rounds N] [--kernels NAME] [--json FILE] [--first-pose PROGRAM]
//                   [Google Benchmark's options]
#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/wait.h>

#include <charconv>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "tests/bench/cpu_clock.h"
#include "tests/bench/kernel_choice.h"
#include "tests/bench/paired.h"
#include "tests/bench/scaling.h"

extern char** environ;

namespace {

using namespace touchline::bench;

struct Options {
  std::string data, json = "bench.json", first_pose;
  int rounds = 7;
  KernelChoice kernels;
};

/// Google Benchmark prints its own options behind these.
void print_help() {
  std::printf(
      "touchline_bench: our stages beside OpenCV's, then how our cost grows.\n"
      "  --data FOLDER         frames of this data set; else of the simulator\n"
      "  --rounds N            times through all frames, 1 to 1000 [7]\n"
      "  --kernels NAME        %s [%s, the fastest]\n"
      "  --json FILE           the medians of the paired stages [bench.json]\n"
      "  --first-pose PROGRAM  takes the time of this program, first_pose, too; it takes the fastest kernels always\n"
      "What is below are Google Benchmark's options, for the rows after the tables.\n\n",
      kernel_names().c_str(), touchline::fastest_kernels().name);
}

int rounds_of(std::string_view text) {
  int rounds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rounds);
  if (error != std::errc() || end != text.data() + text.size() || rounds < 1 || rounds > 1000)
    throw std::runtime_error("--rounds " + std::string(text) + ": write a whole number from 1 to 1000");
  return rounds;
}

/// Takes ours out of the arguments and leaves Google Benchmark's.
Options take_options(int& argc, char** argv) {
  Options options;
  int kept = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string key = argv[i];
    const bool value = i + 1 < argc;
    if (key == "--data" && value) {
      options.data = argv[++i];
    } else if (key == "--json" && value) {
      options.json = argv[++i];
    } else if (key == "--rounds" && value) {
      options.rounds = rounds_of(argv[++i]);
    } else if (key == "--kernels" && value) {
      options.kernels = kernels_named(argv[++i]);
    } else if (key == "--first-pose" && value) {
      options.first_pose = argv[++i];
    } else {
      if (key == "--help") print_help();
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
  return options;
}

/// Wall time of the whole process, start to end; 0 when it could not be run.
double run_first_pose(const std::string& program, const std::string& raw) {
  std::vector<double> samples;
  for (int i = 0; i < 21; ++i) {
    char* arguments[] = {const_cast<char*>(program.c_str()), const_cast<char*>(raw.c_str()), nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", 1, 0);
    const auto begin = std::chrono::steady_clock::now();
    pid_t child = 0;
    int status = 1;
    const bool ran = posix_spawn(&child, program.c_str(), &actions, nullptr, arguments, environ) == 0 &&
                     waitpid(child, &status, 0) == child;
    const std::chrono::duration<double, std::micro> us = std::chrono::steady_clock::now() - begin;
    posix_spawn_file_actions_destroy(&actions);
    if (!ran || status != 0) return 0.0;
    samples.push_back(us.count());
  }
  return spread_of(samples).median;
}

/// As the operating system names it; empty where it does not.
std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  }
  return {};
}

void print_run(const Options& options, const FramePool& pool, const PairedResult& r) {
  const std::string processor = processor_name();
  std::printf("Processor: %s; kernels: %s, %s.\n", processor.empty() ? "not named" : processor.c_str(),
              options.kernels.vision.name, options.kernels.localization.name);
  std::printf(
      "Frames: %s, %zu views of %d shots, %dx%d RGB24, %.0f MB in rotation; one thread each;\nboth sides in turn; "
      "processor time of the thread, without the clock's own %.2f us a reading.\n",
      pool.origin.c_str(), pool.views.size(), shots_per_view, pool.width, pool.height,
      static_cast<double>(pool.views.size()) * shots_per_view * pool.width * pool.height * 3 / 1048576.0,
      clock_cost_us());
  print_paired(r.rows);
  print_agreement(r.agreement);
  if (r.line_agreement < 0.5)
    std::puts(
        "\nThe two sides took less than half of their line pixels in common: they did different work from there on.");
  const double copy = r.memcpy_us.median;
  std::vector<FigureRow> figures = {
      {"memcpy of one frame", copy, 1.0, "the yardstick, from memory that no cache holds"},
      {"frame to pose", r.frame_to_pose_us.median, r.frame_to_pose_us.median / copy,
       "200 particles, full model, tracking"},
      {"of it graph, junctions, posts", r.features_us.median, r.features_us.median / copy, ""},
      {"of it line points", r.line_points_us.median, r.line_points_us.median / copy, ""},
      {"of it localizer", r.localize_us.median, r.localize_us.median / copy, ""},
      {"frame to first pose", r.frame_to_first_pose_us.median, r.frame_to_first_pose_us.median / copy,
       "from nothing: the search included"},
  };
  if (!options.first_pose.empty() && pool.width == 752 && pool.height == 480) {
    const std::string raw = std::filesystem::temp_directory_path() / "touchline_first_pose.raw";
    const auto& shot = pool.views[0].shots[0];
    std::ofstream(raw, std::ios::binary)
        .write(reinterpret_cast<const char*>(shot.data()), static_cast<std::streamsize>(shot.size()));
    const double us = run_first_pose(options.first_pose, raw);
    const char* const fastest = touchline::fastest_kernels().name;
    const bool same = std::string_view(options.kernels.vision.name) == fastest;
    char note[120];
    std::snprintf(note, sizeof note, "%.1f times a warm frame to pose%s%s", us / r.frame_to_pose_us.median,
                  same ? "" : "; with kernels: ", same ? "" : fastest);
    figures.push_back({"process start to first pose", us, us / copy, us > 0.0 ? note : "could not be run"});
    std::filesystem::remove(raw);
  }
  print_figures("whole", figures);
  int frames_with_drops = 0;
  for (const int drops : r.dropped) frames_with_drops += drops > 0 ? 1 : 0;
  std::printf("\nFrames with something dropped for want of room: %d of %zu.\n\n", frames_with_drops, r.dropped.size());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    const Options options = take_options(argc, argv);
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    const FramePool pool = options.data.empty() ? simulated_frames() : recorded_frames(options.data);
    const PairedResult result = run_paired(pool, options.rounds, options.kernels);
    print_run(options, pool, result);
    if (!write_json(options.json, result.rows)) {
      std::fprintf(stderr, "touchline_bench: %s cannot be written\n", options.json.c_str());
      return 2;
    }
    std::puts(
        "Where Google Benchmark warns below of a library that was built as DEBUG, it means its own, not touchline.\n");
    std::fflush(stdout);  // the warning goes to the other stream
    register_scaling(pool, options.kernels);
    benchmark::RunSpecifiedBenchmarks();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "touchline_bench: %s\n", error.what());
    return 2;
  }
}
