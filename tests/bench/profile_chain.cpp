// SPDX-License-Identifier: Apache-2.0
// A few views, each a few times, so that callgrind can say how many instructions each stage takes (`make profile`).
#include <cstdio>
#include <memory>

#include "tests/bench/chain_under_test.h"

int main(int argc, char** argv) {
  using namespace touchline::bench;
  const FramePool pool = argc == 2 ? recorded_frames(argv[1]) : simulated_frames(3);
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
  std::printf("%d frames\n", frames);
}
