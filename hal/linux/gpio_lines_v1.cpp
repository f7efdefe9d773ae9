// SPDX-License-Identifier: Apache-2.0
// GpioLines on libgpiod 1.x: all calls of that library are in this file.
#include <gpiod.h>

#include "hal/linux/gpio_lines.h"

namespace touchline {
namespace {

constexpr const char* consumer = "touchline";

gpiod_line* as_line(void* handle) { return static_cast<gpiod_line*>(handle); }

int active_low(bool yes) { return yes ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0; }

}  // namespace

Status GpioLines::fail(Status status, const char* what) {
  problem_.set_errno(what, config_.chip.c_str());
  close();
  return status;
}

Status GpioLines::open() {
  if (chip_ != nullptr) return Status::ok;
  problem_.clear();
  chip_ = gpiod_chip_open_lookup(config_.chip.c_str());
  if (chip_ == nullptr) return fail(Status::disconnected, "no GPIO chip");
  if (config_.button_line >= 0) {
    gpiod_line* line = gpiod_chip_get_line(chip_, static_cast<unsigned>(config_.button_line));
    if (line == nullptr) return fail(Status::unsupported, "no line for the button on");
    const int pull = config_.button_pull_up ? GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP : 0;
    int result = gpiod_line_request_input_flags(line, consumer, active_low(config_.button_active_low) | pull);
    // Chips without a pull-up of their own refuse to be asked for one; the board then has it.
    if (result != 0 && pull != 0) {
      result = gpiod_line_request_input_flags(line, consumer, active_low(config_.button_active_low));
    }
    if (result != 0) return fail(Status::unsupported, "the button's line cannot be used on");
    button_ = line;
  }
  if (config_.led_line >= 0) {
    gpiod_line* line = gpiod_chip_get_line(chip_, static_cast<unsigned>(config_.led_line));
    if (line == nullptr) return fail(Status::unsupported, "no line for the light on");
    if (gpiod_line_request_output_flags(line, consumer, active_low(config_.led_active_low), 0) != 0) {
      return fail(Status::unsupported, "the light's line cannot be used on");
    }
    led_ = line;
  }
  return Status::ok;
}

void GpioLines::close() {
  if (button_ != nullptr) gpiod_line_release(as_line(button_));
  if (led_ != nullptr) gpiod_line_release(as_line(led_));
  if (chip_ != nullptr) gpiod_chip_close(chip_);
  button_ = nullptr;
  led_ = nullptr;
  chip_ = nullptr;
}

Result<bool> GpioLines::button_pressed() {
  if (chip_ == nullptr) return Status::disconnected;
  if (button_ == nullptr) return false;
  const int value = gpiod_line_get_value(as_line(button_));
  if (value < 0) return fail(Status::disconnected, "the button cannot be read on");
  return value == 1;
}

Status GpioLines::light(bool on) {
  if (chip_ == nullptr) return Status::disconnected;
  if (led_ == nullptr) return Status::ok;
  return gpiod_line_set_value(as_line(led_), on ? 1 : 0) == 0
             ? Status::ok
             : fail(Status::disconnected, "the light cannot be set on");
}

std::string list_gpio_chips() {
  std::string text;
  gpiod_chip_iter* chips = gpiod_chip_iter_new();
  if (chips == nullptr) return text;
  while (gpiod_chip* chip = gpiod_chip_iter_next(chips)) {  // the iterator closes each chip
    text += std::string("  /dev/") + gpiod_chip_name(chip) + "  " + gpiod_chip_label(chip) + "  " +
            std::to_string(gpiod_chip_num_lines(chip)) + " lines\n";
  }
  gpiod_chip_iter_free(chips);
  return text;
}

}  // namespace touchline
