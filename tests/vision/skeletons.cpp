// SPDX-License-Identifier: Apache-2.0
#include "tests/vision/skeletons.h"

#include "platform/core/rng.h"
#include "tests/support/thinning_memory.h"
#include "vision/image/thinning.h"

namespace touchline::test {
namespace {

void set(Bits& image, int x, int y) {
  if (x >= 0 && y >= 0 && x < image.width && y < image.height) image.view().set(x, y, true);
}

void blob(Bits& image, int x, int y) {  // 3x3, so that thinning keeps the walk connected
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) set(image, x + dx, y + dy);
  }
}

int below(Rng& rng, int bound) { return static_cast<int>(rng.below(static_cast<std::uint32_t>(bound))); }

void walks(Bits& image, Rng& rng) {
  for (int walk = 0; walk < 4; ++walk) {
    int x = below(rng, image.width), y = below(rng, image.height);
    int dx = below(rng, 3) - 1, dy = below(rng, 3) - 1;
    for (int step = 0; step < 60; ++step) {
      if (below(rng, 8) == 0) dx = below(rng, 3) - 1, dy = below(rng, 3) - 1;
      blob(image, x, y);
      x += dx;
      y += dy;
    }
  }
}

void grid(Bits& image, Rng& rng) {
  const int pitch = 4 + below(rng, 12);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if ((x + y / 7) % pitch < 3 || y % pitch < 2 + below(rng, 2)) set(image, x, y);
    }
  }
}

void noise(Bits& image, Rng& rng) {
  const int percent = 5 + below(rng, 60);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (below(rng, 100) < percent) set(image, x, y);
    }
  }
}

}  // namespace

Bits drawn_x() {
  Bits image(41, 41);
  for (int i = 0; i < 41; ++i) set(image, i, 20), set(image, 20, i);
  return image;
}

Bits drawn_l() {
  Bits image(41, 41);
  for (int i = 5; i < 36; ++i) set(image, i, 5), set(image, 35, i);
  return image;
}

Bits drawn_circle(int width, int height, int radius) {  // one pixel wide, by Bresenham's midpoint rule
  Bits image(width, height);
  const int cx = width / 2, cy = height / 2;
  int x = radius, y = 0, error = 1 - radius;
  while (x >= y) {
    for (const int sx : {-1, 1}) {
      for (const int sy : {-1, 1}) set(image, cx + sx * x, cy + sy * y), set(image, cx + sx * y, cy + sy * x);
    }
    ++y;
    if (error < 0) {
      error += 2 * y + 1;
    } else {
      --x;
      error += 2 * (y - x) + 1;
    }
  }
  return image;
}

Bits random_skeleton(unsigned seed) {
  Rng rng(seed);
  Bits image(40 + below(rng, 60), 30 + below(rng, 40));
  switch (seed % 4) {
    case 0: walks(image, rng); break;
    case 1: grid(image, rng); break;
    case 2: noise(image, rng); break;
    default:
      walks(image, rng);
      grid(image, rng);
      break;
  }
  OwnThinningMemory thinning(image.width, image.height);
  (void)thin(image.view(), thinning.memory());
  return image;
}

}  // namespace touchline::test
