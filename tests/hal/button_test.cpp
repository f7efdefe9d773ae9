// SPDX-License-Identifier: Apache-2.0
// Debouncing, short and long presses.
#include "hal/button.h"

#include <doctest/doctest.h>

#include "platform/core/rng.h"

namespace touchline {
namespace {

constexpr MonotonicNs ms = one_millisecond;

struct Presses {
  int short_presses = 0;
  int long_presses = 0;
};

/// Holds a level for a time, looked at every millisecond.
void hold(Button& button, MonotonicNs& now, bool pressed, MonotonicNs duration, Presses& seen) {
  for (const MonotonicNs end = now + duration; now < end; now += ms) {
    const auto event = button.update(pressed, now);
    if (!event.ok()) continue;
    ++(event.value().press == ButtonPress::short_press ? seen.short_presses : seen.long_presses);
  }
}

TEST_CASE("bouncing contacts give one press") {
  Button button;
  MonotonicNs now = one_second;
  Presses seen;
  Rng rng(4);
  hold(button, now, false, 100 * ms, seen);
  for (int round = 0; round < 50; ++round) {
    for (int i = 0; i < 10; ++i) hold(button, now, rng.below(2) == 0, ms * (1 + rng.below(3)), seen);
    hold(button, now, true, 200 * ms, seen);
    for (int i = 0; i < 10; ++i) hold(button, now, rng.below(2) == 0, ms * (1 + rng.below(3)), seen);
    hold(button, now, false, 200 * ms, seen);
  }
  CHECK(seen.short_presses == 50);
  CHECK(seen.long_presses == 0);
}

TEST_CASE("a long press is told while it is held, once, and is no short one") {
  Button button;
  MonotonicNs now = one_second;
  Presses seen;
  hold(button, now, false, 100 * ms, seen);
  hold(button, now, true, 990 * ms, seen);
  CHECK(seen.long_presses == 0);
  hold(button, now, true, 3000 * ms, seen);
  CHECK(seen.long_presses == 1);
  hold(button, now, false, 200 * ms, seen);
  CHECK(seen.short_presses == 0);
  CHECK(seen.long_presses == 1);
}

TEST_CASE("a button held at start, or a glitch, is nothing") {
  Button button;
  MonotonicNs now = one_second;
  Presses seen;
  hold(button, now, true, 5000 * ms, seen);
  hold(button, now, false, 100 * ms, seen);
  hold(button, now, true, 20 * ms, seen);
  hold(button, now, false, 100 * ms, seen);
  CHECK(seen.short_presses + seen.long_presses == 0);
  hold(button, now, true, 100 * ms, seen);
  hold(button, now, false, 100 * ms, seen);
  CHECK(seen.short_presses == 1);
}

}  // namespace
}  // namespace touchline
