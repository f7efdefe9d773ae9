// SPDX-License-Identifier: Apache-2.0
// The panel on GPIO lines. The button's level is looked at, not its edges: a chip on USB that polls, reports an edge
// too many at start and loses short ones then does no harm.
#pragma once

#include "hal/button.h"
#include "hal/linux/gpio_lines.h"
#include "hal/panel.h"

namespace touchline {

class GpioPanel final : public Panel {
 public:
  explicit GpioPanel(const GpioLinesConfig& config, const ButtonTiming& timing = {})
      : lines_(config), button_(timing) {}

  [[nodiscard]] const char* problem() const { return lines_.problem(); }

 private:
  /// Reading a line of a chip on USB takes a transfer of a millisecond; a thumb is slower than this.
  static constexpr MonotonicNs poll_period = 10 * one_millisecond;

  Status do_open() override;
  void do_close() override;
  Result<ButtonEvent> do_poll(MonotonicNs now) override;
  void do_show(LedPattern pattern) override { pattern_ = pattern; }
  DeviceHealth do_health() const override { return health_; }
  Status note(Status status);

  GpioLines lines_;
  Button button_;
  DeviceHealth health_;
  LedPattern pattern_ = LedPattern::off;
  bool lit_ = false;
  bool polled_ = false;
  MonotonicNs last_poll_ = 0;
};

}  // namespace touchline
