// SPDX-License-Identifier: Apache-2.0
// GpioLines on libgpiod 2.x: all calls of that library are in this file. Compiled where its headers are found.
#include <gpiod.h>

#include "hal/linux/gpio_lines.h"

namespace touchline {
namespace {

constexpr const char* consumer = "touchline";

gpiod_line_request* as_request(void* handle) { return static_cast<gpiod_line_request*>(handle); }

/// A path as it is; a label by looking at every chip. Null when there is none.
gpiod_chip* open_chip(const std::string& name) {
  if (name.starts_with('/')) return gpiod_chip_open(name.c_str());
  for (int number = 0; number < 64; ++number) {
    const std::string path = "/dev/gpiochip" + std::to_string(number);
    gpiod_chip* chip = gpiod_is_gpiochip_device(path.c_str()) ? gpiod_chip_open(path.c_str()) : nullptr;
    if (chip == nullptr) continue;
    gpiod_chip_info* info = gpiod_chip_get_info(chip);
    const bool found = info != nullptr && name == gpiod_chip_info_get_label(info);
    if (info != nullptr) gpiod_chip_info_free(info);
    if (found) return chip;
    gpiod_chip_close(chip);
  }
  return nullptr;
}

/// Asks for one line. Null when the chip refuses; everything made on the way is freed.
gpiod_line_request* request_line(gpiod_chip* chip, unsigned offset, bool output, bool active_low, bool pull_up) {
  gpiod_line_settings* settings = gpiod_line_settings_new();
  gpiod_line_config* lines = gpiod_line_config_new();
  gpiod_request_config* config = gpiod_request_config_new();
  gpiod_line_request* request = nullptr;
  if (settings != nullptr && lines != nullptr && config != nullptr) {
    gpiod_request_config_set_consumer(config, consumer);
    gpiod_line_settings_set_direction(settings, output ? GPIOD_LINE_DIRECTION_OUTPUT : GPIOD_LINE_DIRECTION_INPUT);
    gpiod_line_settings_set_active_low(settings, active_low);
    if (pull_up) gpiod_line_settings_set_bias(settings, GPIOD_LINE_BIAS_PULL_UP);
    if (output) gpiod_line_settings_set_output_value(settings, GPIOD_LINE_VALUE_INACTIVE);
    if (gpiod_line_config_add_line_settings(lines, &offset, 1, settings) == 0) {
      request = gpiod_chip_request_lines(chip, config, lines);
    }
  }
  if (config != nullptr) gpiod_request_config_free(config);
  if (lines != nullptr) gpiod_line_config_free(lines);
  if (settings != nullptr) gpiod_line_settings_free(settings);
  return request;
}

}  // namespace

Status GpioLines::fail(Status status, const char* what) {
  problem_.set_errno(what, config_.chip.c_str());
  close();
  return status;
}

Status GpioLines::open() {
  if (chip_ != nullptr) return Status::ok;
  problem_.clear();
  chip_ = open_chip(config_.chip);
  if (chip_ == nullptr) return fail(Status::disconnected, "no GPIO chip");
  if (config_.button_line >= 0) {
    const auto offset = static_cast<unsigned>(config_.button_line);
    button_ = request_line(chip_, offset, false, config_.button_active_low, config_.button_pull_up);
    // Chips without a pull-up of their own refuse to be asked for one; the board then has it.
    if (button_ == nullptr && config_.button_pull_up) {
      button_ = request_line(chip_, offset, false, config_.button_active_low, false);
    }
    if (button_ == nullptr) return fail(Status::unsupported, "the button's line cannot be used on");
  }
  if (config_.led_line >= 0) {
    led_ = request_line(chip_, static_cast<unsigned>(config_.led_line), true, config_.led_active_low, false);
    if (led_ == nullptr) return fail(Status::unsupported, "the light's line cannot be used on");
  }
  return Status::ok;
}

void GpioLines::close() {
  if (button_ != nullptr) gpiod_line_request_release(as_request(button_));
  if (led_ != nullptr) gpiod_line_request_release(as_request(led_));
  if (chip_ != nullptr) gpiod_chip_close(chip_);
  button_ = nullptr;
  led_ = nullptr;
  chip_ = nullptr;
}

Result<bool> GpioLines::button_pressed() {
  if (chip_ == nullptr) return Status::disconnected;
  if (button_ == nullptr) return false;
  const auto value = gpiod_line_request_get_value(as_request(button_), static_cast<unsigned>(config_.button_line));
  if (value == GPIOD_LINE_VALUE_ERROR) return fail(Status::disconnected, "the button cannot be read on");
  return value == GPIOD_LINE_VALUE_ACTIVE;
}

Status GpioLines::light(bool on) {
  if (chip_ == nullptr) return Status::disconnected;
  if (led_ == nullptr) return Status::ok;
  const auto value = on ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
  const int result = gpiod_line_request_set_value(as_request(led_), static_cast<unsigned>(config_.led_line), value);
  return result == 0 ? Status::ok : fail(Status::disconnected, "the light cannot be set on");
}

std::string list_gpio_chips() {
  std::string text;
  for (int number = 0; number < 64; ++number) {
    const std::string path = "/dev/gpiochip" + std::to_string(number);
    gpiod_chip* chip = gpiod_is_gpiochip_device(path.c_str()) ? gpiod_chip_open(path.c_str()) : nullptr;
    if (chip == nullptr) continue;
    if (gpiod_chip_info* info = gpiod_chip_get_info(chip)) {
      text += "  " + path + "  " + gpiod_chip_info_get_label(info) + "  " +
              std::to_string(gpiod_chip_info_get_num_lines(info)) + " lines\n";
      gpiod_chip_info_free(info);
    }
    gpiod_chip_close(chip);
  }
  return text;
}

}  // namespace touchline
