// SPDX-License-Identifier: Apache-2.0
// A few views, each a few times, so that callgrind can say how many instructions each stage takes (`make profile`).
//   profile_chain [DATA_SET]     without one, views of the simulator
#include <cstdio>
#include <exception>
#include <memory>

#include "tests/bench/chain_under_test.h"

namespace {

using namespace touchline::bench;

int play(const FramePool& pool) {
  auto chain = std::make_unique<ChainUnderTest<>>();
  chain->configure(pool);
  int frames = 0;
  for (const View& view : pool.views) {
    if (frames >= 12) break;
    chain->pipeline.reset();
    chain->expect_near(view.truth);
    for (int shot = 0; shot < shots_per_view; ++shot) {
      chain->see(pool.frame(view, shot), view.mount, 0.02 * shot);
      (void)chain->locate(view, 0.02 * shot);
      ++frames;
    }
  }
  return frames;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2) {
    std::fputs("usage: profile_chain [DATA_SET]\n", stderr);
    return 2;
  }
  try {
    std::printf("%d frames\n", play(argc == 2 ? recorded_frames(argv[1]) : simulated_frames(3)));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "profile_chain: %s\n", error.what());
    return 2;
  }
}
