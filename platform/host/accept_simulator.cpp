// SPDX-License-Identifier: Apache-2.0
// The acceptance figures of the simulator. Runs are independent of each other and are shared out over threads; results
// are kept by number, so that the figures do not depend on who ran what.
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "platform/host/accept.h"
#include "platform/host/evaluate.h"
#include "platform/host/host_error.h"
#include "platform/host/sim/scenario.h"

namespace touchline::host {
namespace {

constexpr std::uint64_t first_seed = 1000;  // of the acceptance runs; development uses smaller ones

CameraSetup setup_of(const sim::SimCameraModel& camera, const CameraPose& mount) {
  return {camera.width, camera.height, camera.lens, mount};
}

/// Calls task(worker, i) for 0 <= i < count on some threads. The first exception is thrown again here.
void in_parallel(int count, int threads, const std::function<void(std::size_t, int)>& task) {
  std::atomic<int> next{0};
  std::exception_ptr failure;
  std::mutex lock;
  const auto work = [&](std::size_t worker) {
    try {
      for (int i = next++; i < count; i = next++) task(worker, i);
    } catch (...) {
      const std::lock_guard hold(lock);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> pool;
  for (int i = 1; i < threads; ++i) pool.emplace_back(work, static_cast<std::size_t>(i));
  work(0);
  for (auto& thread : pool) thread.join();
  if (failure) std::rethrow_exception(failure);
}

template <typename T>
T found(const std::optional<T>& value, const char* name) {
  if (!value) throw HostError(std::string("the simulator has no ") + name);
  return *value;
}

PoseError locate_from_nothing(Chain& chain, const sim::SimFrame& frame, const sim::SimCameraModel& camera,
                              std::uint64_t seed) {
  chain.forget(seed);
  chain.see(frame.image, 0.0, setup_of(camera, frame.mount), {}, nullptr);
  LocalizerInput input;
  PoseEstimate estimate;
  for (int i = 0; i < max_shows && !estimate.settled; ++i) {
    estimate = chain.locate(input, nullptr);
    input.time_s += default_frame_s;
  }
  return judge_up_to_mirror(frame.truth, estimate);
}

Figures pose_figures(const SimulatorRuns& runs) {
  sim::PoseScenarioOptions options;
  options.field = found(field_preset("acyut-5x3"), "acyut-5x3");
  options.camera = found(sim::camera_model("fisheye-185"), "fisheye-185");
  options.seed = first_seed;
  std::vector<PoseError> errors(static_cast<std::size_t>(runs.poses));
  const int block = options.frames_per_scene;
  const auto workers = static_cast<std::size_t>(runs.threads);
  std::vector<std::unique_ptr<sim::PoseScenario>> scenarios(workers);  // the rays of a lens take long to tabulate
  std::vector<std::unique_ptr<Chain>> chains(workers);
  in_parallel((runs.poses + block - 1) / block, runs.threads, [&](std::size_t worker, int b) {
    auto& scenario = scenarios[worker];
    auto& chain = chains[worker];
    if (!scenario) scenario = std::make_unique<sim::PoseScenario>(options);
    if (!chain) chain = std::make_unique<Chain>(ChainOptions{}, options.field);
    for (int i = b * block; i < std::min(runs.poses, (b + 1) * block); ++i) {
      const sim::SimFrame& frame = scenario->frame(i);
      errors[static_cast<std::size_t>(i)] =
          locate_from_nothing(*chain, frame, options.camera, first_seed + static_cast<std::uint64_t>(i));
    }
  });
  int near = 0;
  int outside = 0;
  for (const auto& error : errors) {
    near += error.has_pose && error.distance_m <= 0.10 ? 1 : 0;
    outside += error.outside_3_sigma ? 1 : 0;
  }
  return {{"simulator, acyut-5x3 poses: within 0.10 m", 100.0 * near / runs.poses, false, 98.0, 99.5, "%"},
          {"simulator, acyut-5x3 poses: outside 3 sigma", 100.0 * outside / runs.poses, true, std::nullopt, 2.0, "%"}};
}

SequenceScore walk(const sim::WalkScenarioOptions& options, double seconds, int& outside) {
  sim::WalkScenario scenario(options);
  Chain chain({}, options.walk.field);
  chain.forget(options.seed);
  std::vector<JudgedFrame> judged;
  const int frames = static_cast<int>(seconds * static_cast<double>(options.frames_per_second));
  for (int i = 0; i < frames; ++i) {
    const sim::SimFrame& frame = scenario.next();
    chain.see(frame.image, frame.time_s, setup_of(options.camera, frame.mount), frame.odometry, nullptr);
    LocalizerInput input;
    input.time_s = frame.time_s;
    input.odometry = frame.odometry;
    input.has_yaw = frame.has_yaw;
    input.yaw = wrap_angle(frame.yaw);
    input.moved_by_hand = frame.moved_by_hand;
    judged.push_back({frame.time_s, frame.kidnapped, judge(frame.truth, chain.locate(input, nullptr))});
    outside += judged.back().error.outside_3_sigma ? 1 : 0;
  }
  return judge_sequence(judged);
}

Figures walk_figures(const SimulatorRuns& runs, const char* preset) {
  const FieldDimensions field = found(field_preset(preset), preset);
  const sim::SimCameraModel camera = found(sim::camera_model("fisheye-140"), "fisheye-140");
  const auto count = static_cast<std::size_t>(runs.walks);
  std::vector<double> rmse(count);
  std::vector<int> outside(count);
  std::vector<int> lost(count);
  in_parallel(runs.walks, runs.threads, [&](std::size_t, int i) {
    const auto n = static_cast<std::size_t>(i);
    const auto options = sim::acceptance_walk(field, camera, first_seed + static_cast<std::uint64_t>(i));
    const SequenceScore score = walk(options, runs.walk_s, outside[n]);
    lost[n] = score.without_pose;
    rmse[n] = score.counted > score.without_pose ? score.rmse_m : std::numeric_limits<double>::infinity();
  });
  int outside_sum = 0;
  int lost_sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    outside_sum += outside[i];
    lost_sum += lost[i];
  }
  const double frames = runs.walks * std::floor(runs.walk_s * 12.0);
  const std::string name = std::string("simulator, ") + preset + " walks: ";
  return {{name + "median of the RMSE", quantile(rmse, 0.5), true, 0.15, 0.05, "m"},
          {name + "worst RMSE", quantile(rmse, 1.0), true, std::nullopt, std::nullopt, "m"},
          {name + "frames without a pose", 100.0 * lost_sum / frames, true, std::nullopt, std::nullopt, "%"},
          {name + "outside 3 sigma", 100.0 * outside_sum / frames, true, std::nullopt, 2.0, "%"}};
}

}  // namespace

Figures accept_simulator(const SimulatorRuns& runs, const Progress& progress) {
  progress("simulator: " + std::to_string(runs.poses) + " single poses on acyut-5x3");
  Figures figures = pose_figures(runs);
  for (const char* preset : {"small-2026", "middle-2026"}) {
    progress("simulator: " + std::to_string(runs.walks) + " walks on " + preset);
    const Figures more = walk_figures(runs, preset);
    figures.insert(figures.end(), more.begin(), more.end());
  }
  return figures;
}

}  // namespace touchline::host
