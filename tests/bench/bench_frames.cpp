// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/bench_frames.h"

#include <algorithm>

#include "platform/core/rng.h"
#include "platform/host/dataset.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "platform/host/sim/scenario.h"

namespace touchline::bench {
namespace {

/// The same picture with fresh noise of one or two grey levels, as the next frame of a camera that stands still.
std::vector<std::uint8_t> next_shot(const std::vector<std::uint8_t>& picture, Rng& rng) {
  std::vector<std::uint8_t> shot(picture);
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < shot.size(); ++i) {
    if (i % 32 == 0) bits = std::uint64_t{rng.next_u32()} << 32U | rng.next_u32();
    const int noise = static_cast<int>(bits & 3U) - 1;
    bits >>= 2U;
    shot[i] = static_cast<std::uint8_t>(std::clamp(shot[i] + noise, 0, 255));
  }
  return shot;
}

void add_shots(View& view, std::vector<std::uint8_t> picture, Rng& rng) {
  view.shots.push_back(std::move(picture));
  while (view.shots.size() < static_cast<std::size_t>(shots_per_view))
    view.shots.push_back(next_shot(view.shots[0], rng));
}

int views_for(int width, int height) {
  const std::size_t view_bytes = static_cast<std::size_t>(width * height * 3 * shots_per_view);
  return static_cast<int>((pool_bytes + view_bytes - 1) / view_bytes);
}

}  // namespace

FramePool simulated_frames(int views) {
  sim::PoseScenarioOptions options;
  options.field = *field_preset("small-2026");
  options.camera = *sim::camera_model("fisheye-185");
  options.seed = 11;
  options.yaw = true;
  options.frames_per_scene = 5;
  sim::PoseScenario scenario(options);
  FramePool pool{options.field, options.camera.lens, options.camera.width, options.camera.height, "simulator", {}};
  if (views == 0) views = views_for(pool.width, pool.height);
  Rng rng(5);
  for (int i = 0; i < views; ++i) {
    const sim::SimFrame& frame = scenario.frame(i);
    View view{frame.mount, frame.has_yaw, wrap_angle(frame.yaw), frame.truth, {}};
    const std::size_t bytes = static_cast<std::size_t>(pool.width * pool.height * 3);
    add_shots(view, std::vector<std::uint8_t>(frame.image.data, frame.image.data + bytes), rng);
    pool.views.push_back(std::move(view));
  }
  return pool;
}

FramePool recorded_frames(const std::string& folder) {
  const host::DataSet set = host::read_dataset(folder);
  FramePool pool{set.field, set.camera.lens, set.camera.width, set.camera.height, set.name, {}};
  std::vector<const host::DataFrame*> usable;
  for (const host::DataFrame& frame : set.frames) {
    if (frame.camera.width == pool.width && frame.camera.height == pool.height) usable.push_back(&frame);
  }
  if (usable.empty()) throw host::HostError(folder + ": frames.jsonl: no frame of the data set's camera size");
  Rng rng(5);
  const int views = views_for(pool.width, pool.height);
  for (int i = 0; i < views; ++i) {
    const host::DataFrame& frame = *usable[static_cast<std::size_t>(i) % usable.size()];
    View view{frame.camera.mount, frame.has_yaw, frame.yaw, frame.truth, {}};
    add_shots(view, host::read_frame_image(frame).rgb, rng);
    pool.views.push_back(std::move(view));
  }
  return pool;
}

const char* to_string(WorstKind kind) {
  switch (kind) {
    case WorstKind::white_noise: return "white noise";
    case WorstKind::checkerboard: return "checkerboard";
    case WorstKind::turned_checkerboard: return "turned checkerboard";
    case WorstKind::blocks: return "blocks";
    case WorstKind::noise_in_green: return "noise in green";
    case WorstKind::all_white: return "all white";
    case WorstKind::all_green: return "all green";
  }
  return "?";
}

namespace {

/// Whether a pixel of a pattern without noise is white.
bool is_white(WorstKind kind, int x, int y, std::uint64_t seed) {
  constexpr int block_px = 12;
  switch (kind) {
    case WorstKind::all_white: return true;
    // Four camera pixels a square, about two working ones: the finest pattern that the subsampling lets through.
    case WorstKind::checkerboard: return (x / 5 + y / 4) % 2 == 0;
    case WorstKind::turned_checkerboard: return (x / 4 + y / 5) % 2 == 0;
    case WorstKind::blocks:
      return Rng(seed * 1000003U + static_cast<std::uint64_t>(y / block_px * 1000 + x / block_px)).below(2) == 0;
    default: return false;
  }
}

}  // namespace

std::vector<std::uint8_t> worst_frame(WorstKind kind, int width, int height, std::uint64_t seed) {
  constexpr std::uint8_t green[3] = {40, 120, 60};
  constexpr std::uint8_t white = 235;
  Rng rng(seed);
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width * height * 3));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      std::uint8_t* pixel = &rgb[static_cast<std::size_t>((y * width + x) * 3)];
      const bool inside = x > width / 6 && x < width * 5 / 6 && y > height / 3 && y < height * 9 / 10;
      const bool noise = kind == WorstKind::white_noise || (kind == WorstKind::noise_in_green && inside);
      const std::uint32_t bits = noise ? rng.next_u32() : 0;
      const bool bright = noise ? (bits & 1U) != 0 : is_white(kind, x, y, seed);
      for (unsigned c = 0; c < 3; ++c) {
        pixel[c] = bright ? white : green[c];
        if (kind == WorstKind::white_noise) pixel[c] = static_cast<std::uint8_t>(bits >> (8 * c));
      }
    }
  }
  return rgb;
}

}  // namespace touchline::bench
