// SPDX-License-Identifier: Apache-2.0
// The light's patterns, told apart by how often they change in a second; and that the interface headers stand alone.
#include "hal/panel.h"

#include <doctest/doctest.h>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/gait_link.h"
#include "hal/imu.h"

namespace touchline {
namespace {

int rising_edges(LedPattern pattern) {
  int edges = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    const bool before = led_is_on(pattern, (ms + 999) * one_millisecond);
    edges += led_is_on(pattern, ms * one_millisecond) && !before ? 1 : 0;
  }
  return edges;
}

TEST_CASE("the patterns of the light differ in their number of flashes a second") {
  CHECK(rising_edges(LedPattern::off) == 0);
  CHECK_FALSE(led_is_on(LedPattern::off, 0));
  CHECK(rising_edges(LedPattern::sure) == 0);
  CHECK(led_is_on(LedPattern::sure, 123456789));
  CHECK(rising_edges(LedPattern::searching) == 1);
  CHECK(rising_edges(LedPattern::no_camera) == 2);
  CHECK(rising_edges(LedPattern::fault) == 5);
}

TEST_CASE("seconds and nanoseconds convert both ways") {
  CHECK(from_seconds(1.5) == 1'500'000'000);
  CHECK(from_seconds(-0.25) == -250'000'000);
  CHECK(to_seconds(250'000'000) == doctest::Approx(0.25));
}

}  // namespace
}  // namespace touchline
