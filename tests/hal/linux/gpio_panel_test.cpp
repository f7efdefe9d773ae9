// SPDX-License-Identifier: Apache-2.0
// The panel against a fake of libgpiod; linked once for each of the library's two APIs.
#include "hal/linux/gpio_panel.h"

#include <doctest/doctest.h>

#include <string_view>

#include "tests/support/fake_gpiod.h"

namespace touchline {
namespace {

constexpr MonotonicNs ms = one_millisecond;

struct Bench {
  Bench() {
    fake::reset_gpiod();
    config.button_line = 2;
    config.led_line = 5;
  }
  ~Bench() { check_all_closed(); }
  void check_all_closed() const {
    CHECK(fake::requested_lines() == (panel_open ? 2 : 0));
    CHECK(device.open_chips == (panel_open ? 1 : 0));
  }
  fake::Gpiod& device = fake::gpiod();
  GpioLinesConfig config;
  bool panel_open = false;
};

/// Polls every 5 ms for `duration`; the last press, if any.
Result<ButtonEvent> poll_for(GpioPanel& panel, MonotonicNs& now, MonotonicNs duration) {
  Result<ButtonEvent> last = Status::not_ready;
  for (const MonotonicNs end = now + duration; now < end; now += 5 * ms) {
    const auto event = panel.poll(now);
    if (event.ok()) last = event;
  }
  return last;
}

TEST_CASE("a short and a long press") {
  Bench bench;
  GpioPanel panel(bench.config);
  CHECK(panel.poll(0).status() == Status::disconnected);
  REQUIRE(panel.open() == Status::ok);
  CHECK(panel.open() == Status::ok);
  CHECK(bench.device.active_low[2]);
  CHECK_FALSE(bench.device.output[2]);
  CHECK(bench.device.output[5]);
  MonotonicNs now = one_second;
  CHECK_FALSE(poll_for(panel, now, 100 * ms).ok());
  bench.device.level[2] = 1;
  CHECK_FALSE(poll_for(panel, now, 300 * ms).ok());
  bench.device.level[2] = 0;
  CHECK(poll_for(panel, now, 100 * ms).value().press == ButtonPress::short_press);
  bench.device.level[2] = 1;
  const auto press = poll_for(panel, now, 1200 * ms);
  REQUIRE(press.ok());
  CHECK(press.value().press == ButtonPress::long_press);
  bench.device.level[2] = 0;
  CHECK_FALSE(poll_for(panel, now, 200 * ms).ok());
  CHECK(panel.health().received == 2);
  panel.close();
  bench.check_all_closed();
}

TEST_CASE("the light plays its pattern and is off when the panel closes") {
  Bench bench;
  GpioPanel panel(bench.config);
  REQUIRE(panel.open() == Status::ok);
  panel.show(LedPattern::sure);
  MonotonicNs now = one_second;
  (void)poll_for(panel, now, 50 * ms);
  CHECK(bench.device.level[5] == 1);
  panel.show(LedPattern::fault);
  int changes = 0;
  int before = bench.device.level[5];
  for (int i = 0; i < 200; ++i, now += 5 * ms) {
    (void)panel.poll(now);
    changes += bench.device.level[5] != before ? 1 : 0;
    before = bench.device.level[5];
  }
  CHECK(changes >= 9);
  CHECK(changes <= 11);
  panel.show(LedPattern::sure);
  (void)poll_for(panel, now, 50 * ms);
  panel.close();
  CHECK(bench.device.level[5] == 0);
}

TEST_CASE("the chip is found by its label; without a pull-up it is used as it is") {
  Bench bench;
  bench.config.chip = "fake";
  bench.device.has_pull_up = false;
  GpioPanel panel(bench.config);
  CHECK(panel.open() == Status::ok);
  panel.close();
}

TEST_CASE("what cannot be opened says why and leaves nothing open") {
  Bench bench;
  bench.config.chip = "/dev/gpiochip9";
  GpioPanel none(bench.config);
  CHECK(none.open() == Status::disconnected);
  CHECK(std::string_view(none.problem()).find("/dev/gpiochip9") != std::string_view::npos);
  bench.config.chip = "/dev/gpiochip0";
  bench.config.button_line = 30;
  CHECK(GpioPanel(bench.config).open() == Status::unsupported);
  bench.config.button_line = 2;
  bench.config.led_line = 31;
  CHECK(GpioPanel(bench.config).open() == Status::unsupported);
  bench.config.led_line = 5;
  bench.device.busy = true;
  GpioPanel panel(bench.config);
  CHECK(panel.open() == Status::unsupported);
  bench.config.button_line = -1;
  CHECK(GpioPanel(bench.config).open() == Status::unsupported);  // the light's line
  CHECK(bench.device.open_objects == 0);
  bench.check_all_closed();
  bench.device.busy = false;
  bench.device.fail_allocation = true;  // only the second API has objects to run out of
  (void)panel.open();
  panel.close();
  CHECK(bench.device.open_objects == 0);
  bench.check_all_closed();
  bench.device.fail_allocation = false;
  CHECK(panel.open() == Status::ok);
  panel.close();
}

TEST_CASE("a panel without a button or without a light works with the other") {
  Bench bench;
  bench.config.button_line = -1;
  GpioPanel light_only(bench.config);
  REQUIRE(light_only.open() == Status::ok);
  light_only.show(LedPattern::sure);
  CHECK(light_only.poll(one_second).status() == Status::not_ready);
  CHECK(bench.device.level[5] == 1);
  light_only.close();
  bench.config.button_line = 2;
  bench.config.led_line = -1;
  GpioPanel button_only(bench.config);
  REQUIRE(button_only.open() == Status::ok);
  button_only.show(LedPattern::sure);
  CHECK(button_only.poll(one_second).status() == Status::not_ready);
  button_only.close();
}

TEST_CASE("a chip that is unplugged is disconnected and comes back by open()") {
  Bench bench;
  GpioPanel panel(bench.config);
  REQUIRE(panel.open() == Status::ok);
  bench.device.present = false;
  CHECK(panel.poll(one_second).status() == Status::disconnected);
  CHECK_FALSE(panel.health().open);
  bench.check_all_closed();
  CHECK(panel.open() == Status::disconnected);
  bench.device.present = true;
  CHECK(panel.open() == Status::ok);
  panel.show(LedPattern::sure);
  CHECK(panel.poll(2 * one_second).status() == Status::not_ready);
  bench.device.present = false;
  panel.show(LedPattern::off);
  CHECK(panel.poll(3 * one_second).status() == Status::disconnected);  // the light's write fails first
  CHECK(panel.health().opened == 2);
}

TEST_CASE("chips are listed") {
  Bench bench;
  CHECK(list_gpio_chips() == "  /dev/gpiochip0  fake  8 lines\n");
  bench.device.present = false;
  CHECK(list_gpio_chips().empty());
}

}  // namespace
}  // namespace touchline
