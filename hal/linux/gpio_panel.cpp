// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/gpio_panel.h"

namespace touchline {

Status GpioPanel::note(Status status) {
  health_.last_error = status;
  health_.open = lines_.is_open();
  return status;
}

Status GpioPanel::do_open() {
  if (lines_.is_open()) return Status::ok;
  const Status status = lines_.open();
  if (status != Status::ok) return note(status);
  button_.reset();
  lit_ = false;
  polled_ = false;
  health_.open = true;
  ++health_.opened;
  return Status::ok;
}

void GpioPanel::do_close() {
  if (lines_.is_open()) (void)lines_.light(false);  // a light that stays on would tell of a program that is gone
  lines_.close();
  health_.open = false;
}

Result<ButtonEvent> GpioPanel::do_poll(MonotonicNs now) {
  if (!lines_.is_open()) return Status::disconnected;
  if (polled_ && now - last_poll_ < poll_period) return Status::not_ready;
  polled_ = true;
  last_poll_ = now;
  const bool lit = led_is_on(pattern_, now);
  if (lit != lit_) {
    const Status status = lines_.light(lit);
    if (status != Status::ok) return note(status);
    lit_ = lit;
  }
  const Result<bool> pressed = lines_.button_pressed();
  if (!pressed.ok()) return note(pressed.status());
  const Result<ButtonEvent> event = button_.update(pressed.value(), now);
  if (event.ok()) {
    ++health_.received;
    health_.last_datum = now;
  }
  return event;
}

}  // namespace touchline
