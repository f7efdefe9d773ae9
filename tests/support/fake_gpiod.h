// SPDX-License-Identifier: Apache-2.0
// A fake GPIO chip behind a fake of libgpiod, linked in its place. Two libraries, one for each API; one state for both.
#pragma once

#include <array>
#include <string>

namespace touchline::fake {

struct Gpiod {
  bool present = true;
  std::string path = "/dev/gpiochip0";
  std::string label = "fake";
  int line_count = 8;
  bool has_pull_up = true;  // false: a request for one is refused
  bool busy = false;        // another program has the lines
  bool fail_allocation = false;

  std::array<int, 8> level{};  // logical: 1 is active
  std::array<bool, 8> requested{};
  std::array<bool, 8> output{};
  std::array<bool, 8> active_low{};
  int open_chips = 0;
  int open_objects = 0;  // settings, configs, infos of the second API
};

Gpiod& gpiod();
void reset_gpiod();
/// Lines in use now.
int requested_lines();

}  // namespace touchline::fake
