// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/scaling.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "platform/core/elementary.h"
#include "platform/core/rng.h"
#include "tests/bench/chain_under_test.h"
#include "tests/support/synthetic_view.h"
#include "vision/digestion.h"
#include "vision/graph_storage.h"
#include "vision/image/bit_ops.h"
#include "vision/image/subsample.h"
#include "vision/node_graph.h"

namespace touchline::bench {
namespace {

void time_memcpy(benchmark::State& state, const FramePool& pool) {
  std::vector<std::uint8_t> target(pool.views[0].shots[0].size());
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& shots = pool.views[i / shots_per_view % pool.views.size()].shots;
    std::memcpy(target.data(), shots[i % shots_per_view].data(), target.size());
    benchmark::ClobberMemory();
    ++i;
  }
}

/// All of vision at one working size, view after view.
void time_vision(benchmark::State& state, const FramePool& pool, const KernelChoice& kernels, int work_width,
                 int work_height) {
  auto chain = std::make_unique<ChainUnderTest<640, 480, 4>>(kernels);
  chain->configure(pool, work_width, work_height);
  std::size_t i = 0;
  for (auto _ : state) {
    const View& view = pool.views[i / shots_per_view % pool.views.size()];
    chain->see(pool.frame(view, static_cast<int>(i % shots_per_view)), view.mount, 0.02 * static_cast<double>(i));
    ++i;
  }
}

/// Averaging and subsampling alone, of a 752x480 frame that stays in the cache. No time depends on what it shows.
void time_subsampling(benchmark::State& state, const KernelChoice& kernels, PixelFormat format) {
  constexpr int width = 752, height = 480, work_width = 320, work_height = 240;
  const int stride = width * bytes_per_pixel(format);
  const std::vector<std::uint8_t> frame(static_cast<std::size_t>(stride * height), 90);
  std::vector<std::uint8_t> y(work_width * work_height), cb(y.size() / 4), cr(y.size() / 4);
  const auto storage = std::make_unique<SubsampleStorage<width, work_width>>();
  Subsampler subsampler(storage->memory());
  require(subsampler.configure(width, height, work_width, work_height, kernels.vision), "subsampler");
  for (auto _ : state) {
    require(subsampler.run({format, frame.data(), width, height, stride},
                           {{y.data(), work_width, work_height, work_width},
                            {cb.data(), work_width / 2, work_height / 2, work_width / 2},
                            {cr.data(), work_width / 2, work_height / 2, work_width / 2}}),
            "subsampling");
  }
}

/// What the localizer's target asks for: exactly 12 junctions and 400 line points, seen from a pose in the middle
/// field.
struct LocalizerView {
  Field field;
  Lens lens;
  std::unique_ptr<test::SyntheticView> synthetic;
  Features features;
  VisionResult vision;
  Pose2 truth{1.2F, 0.8F, 0.6F};
  CameraPose camera{0.0F, 0.0F, 0.58F, 0.0F, radians(30.0F), 0.0F};

  explicit LocalizerView(const FramePool& pool) {
    require(Field::create(*field_preset("small-2026"), field), "field");
    require(Lens::create(pool.lens, lens), "lens");
    synthetic = std::make_unique<test::SyntheticView>(field, lens, pool.width, pool.height);
    Rng rng(3);
    test::SyntheticOptions options;
    options.pixel_noise = 0.5F;
    options.max_range = 6.0F;
    vision = synthetic->look(truth, camera, options, rng);
    features = *vision.features;
    while (features.junctions.size() < 12 && !features.junctions.empty()) {
      const Junction again = features.junctions[features.junctions.size() / 2];
      features.junctions.push_back(again);
    }
    while (features.junctions.size() > 12) features.junctions.pop_back();
    StaticVector<LinePoint, max_line_points> points;
    for (std::size_t i = 0; i < 400; ++i)
      points.push_back(vision.features->line_points[i * vision.features->line_points.size() / 400]);
    features.line_points = points;
    vision.features = &features;
  }
};

void time_localizer(benchmark::State& state, const FramePool& pool, const KernelChoice& kernels, int particles,
                    bool tracking) {
  LocalizerView seen(pool);
  auto localizer = std::make_unique<Localizer>();
  LocalizerConfig config;
  config.particles = particles;
  config.kernels = kernels.localization;
  require(localizer->configure(config, seen.field), "localizer");
  const Prior near{.kind = PriorKind::pose, .pose = seen.truth, .sigma_xy = 0.1F, .sigma_theta = radians(5.0F)};
  require(localizer->reset(tracking ? near : Prior{}, 1), "prior");
  LocalizerInput input;
  input.has_yaw = true;
  input.yaw = seen.truth.theta;
  PoseEstimate estimate;
  const auto step = [&] {
    input.time_s += 0.02;
    require(localizer->update(input, seen.vision, estimate), "localization");
  };
  if (tracking) {
    for (int i = 0; i < 10; ++i) step();
  }
  for (auto _ : state) {
    if (!tracking) (void)localizer->reset(Prior{}, 1);
    step();
  }
  state.counters["junctions"] = static_cast<double>(seen.features.junctions.size());
  state.counters["points"] = static_cast<double>(seen.features.line_points.size());
  state.counters["confidence"] = static_cast<double>(estimate.confidence);
}

/// A grid of lines with about `pixels` skeleton pixels, and seeded gaps.
struct DrawnSkeleton {
  BitImage<320, 240> image;
  int pixels = 0;
  explicit DrawnSkeleton(int wanted) {
    Rng rng(9);
    const BitView view = image.view();
    while (pixels < wanted) {
      const bool along = rng.below(2) == 0;
      const int length = 20 + static_cast<int>(rng.below(60));
      const int x0 = 2 + static_cast<int>(rng.below(236));
      const int y0 = 2 + static_cast<int>(rng.below(156));
      for (int k = 0; k < length && pixels < wanted; ++k) {
        const int x = along ? x0 + k : x0;
        const int y = along ? y0 : y0 + k;
        if (x >= 318 || y >= 238 || view.get(x, y)) continue;
        view.set(x, y, true);
        ++pixels;
      }
    }
  }
};

void time_digestion(benchmark::State& state, int radius, int pixels) {
  const DrawnSkeleton skeleton(pixels);
  auto storage = std::make_unique<GraphStorage<320, 240>>();
  const GraphMemory memory = storage->memory();
  SkeletonIndex index(memory.index);
  std::size_t nodes = 0;
  for (auto _ : state) {
    (void)index.build(skeleton.image.view());
    nodes = digest(index, {radius, 1, 10, 100}, memory.digestion).major_nodes.size();
    benchmark::DoNotOptimize(nodes);
  }
  state.counters["pixels"] = skeleton.pixels;
  state.counters["major_nodes"] = static_cast<double>(nodes);
}

/// The worst frames, all the way to the pose, by a robot that does not know where it is.
void time_worst(benchmark::State& state, const FramePool& pool, const KernelChoice& kernels, WorstKind kind) {
  auto chain = std::make_unique<ChainUnderTest<>>(kernels);
  chain->configure(pool);
  std::vector<std::vector<std::uint8_t>> frames;
  for (std::uint64_t i = 0; i < 60; ++i) frames.push_back(worst_frame(kind, pool.width, pool.height, i + 1));
  const View view{pool.views[0].mount, true, 0.0F, {}, {}};
  std::size_t i = 0;
  for (auto _ : state) {
    const FrameView frame{PixelFormat::rgb24, frames[i % frames.size()].data(), pool.width, pool.height,
                          pool.width * 3};
    chain->see(frame, view.mount, 0.02 * static_cast<double>(i));
    (void)chain->locate(view, 0.02 * static_cast<double>(i));
    ++i;
  }
  const VisionCounts& c = chain->vision.counts;
  state.counters["skeleton"] = c.skeleton_pixels;
  state.counters["dropped"] = c.dropped();
}

void time_frame_to_pose(benchmark::State& state, const FramePool& pool, const KernelChoice& kernels) {
  auto chain = std::make_unique<ChainUnderTest<>>(kernels);
  chain->configure(pool);
  std::size_t i = 0;
  for (auto _ : state) {
    const View& view = pool.views[i / shots_per_view % pool.views.size()];
    if (i % shots_per_view == 0) chain->expect_near(view.truth);
    chain->see(pool.frame(view, static_cast<int>(i % shots_per_view)), view.mount, 0.02 * static_cast<double>(i));
    (void)chain->locate(view, 0.02 * static_cast<double>(i));
    ++i;
  }
}

template <typename Function>
void add(const std::string& name, Function function) {
  benchmark::RegisterBenchmark(name.c_str(), function)->Unit(benchmark::kMicrosecond)->MinTime(0.2);
}

}  // namespace

void register_scaling(const FramePool& pool, const KernelChoice& kernels) {
  add("memcpy of one frame", [&pool](benchmark::State& s) { time_memcpy(s, pool); });
  add("frame to pose", [&pool, kernels](benchmark::State& s) { time_frame_to_pose(s, pool, kernels); });
  for (const auto& [name, format] :
       {std::pair{"rgb24", PixelFormat::rgb24}, {"yuyv", PixelFormat::yuyv}, {"rgb565", PixelFormat::rgb565}}) {
    add(std::string("subsampling/") + name,
        [kernels, format = format](benchmark::State& s) { time_subsampling(s, kernels, format); });
  }
  // Each twice the area of the one before.
  for (const auto& [w, h] : {std::pair{160, 120}, {226, 170}, {320, 240}, {452, 340}, {640, 480}}) {
    add("vision/" + std::to_string(w) + "x" + std::to_string(h),
        [&pool, kernels, w = w, h = h](benchmark::State& s) { time_vision(s, pool, kernels, w, h); });
  }
  for (const int n : {50, 100, 200, 400, 800, 1000}) {
    add("localizer/particles:" + std::to_string(n),
        [&pool, kernels, n](benchmark::State& s) { time_localizer(s, pool, kernels, n, true); });
  }
  add("localizer from nothing/particles:200",
      [&pool, kernels](benchmark::State& s) { time_localizer(s, pool, kernels, 200, false); });
  for (const int radius : {3, 5, 7, 10, 14, 20}) {
    add("digestion/radius:" + std::to_string(radius),
        [radius](benchmark::State& s) { time_digestion(s, radius, 1500); });
  }
  for (const int pixels : {375, 750, 1500, 3000, 6000}) {
    add("digestion/pixels:" + std::to_string(pixels), [pixels](benchmark::State& s) { time_digestion(s, 5, pixels); });
  }
  for (const WorstKind kind : worst_kinds) {
    add(std::string("worst frame/") + to_string(kind),
        [&pool, kernels, kind](benchmark::State& s) { time_worst(s, pool, kernels, kind); });
  }
}

}  // namespace touchline::bench
