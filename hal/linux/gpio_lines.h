// SPDX-License-Identifier: Apache-2.0
// The button's and the light's line of a GPIO chip. Two implementations of one interface, one for each API of libgpiod:
// gpio_lines_v1.cpp (1.x, as in Debian 12) and gpio_lines_v2.cpp; the build takes the one that fits the headers it
// finds.
#pragma once

#include <string>

#include "hal/linux/problem.h"
#include "platform/core/result.h"

struct gpiod_chip;  // of <gpiod.h>, which stays out of headers

namespace touchline {

struct GpioLinesConfig {
  std::string chip = "/dev/gpiochip0";  // a path, or the chip's label
  int button_line = -1;                 // offset on the chip; -1: no button
  bool button_active_low = true;        // pressed pulls the line to ground
  bool button_pull_up = true;           // ask the chip for its pull-up; false: there is one outside
  int led_line = -1;                    // -1: no light
  bool led_active_low = false;
};

class GpioLines {
 public:
  explicit GpioLines(const GpioLinesConfig& config) : config_(config) {}
  ~GpioLines() { close(); }
  GpioLines(const GpioLines&) = delete;
  GpioLines& operator=(const GpioLines&) = delete;

  /// disconnected: no such chip. unsupported: no such line, or it is in use.
  Status open();
  void close();
  [[nodiscard]] bool is_open() const { return chip_ != nullptr; }
  /// False without a button. disconnected: the chip is gone (and closed).
  Result<bool> button_pressed();
  /// disconnected: the chip is gone (and closed).
  Status light(bool on);

  [[nodiscard]] const char* problem() const { return problem_.text(); }

 private:
  Status fail(Status status, const char* what);

  GpioLinesConfig config_;
  Problem problem_;
  gpiod_chip* chip_ = nullptr;
  void* button_ = nullptr;  // the library's handles: a line in 1.x, a request in 2.x
  void* led_ = nullptr;
};

/// One line of text per GPIO chip, for `touchline devices`; empty when there is none.
std::string list_gpio_chips();

}  // namespace touchline
