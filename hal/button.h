// SPDX-License-Identifier: Apache-2.0
// A button's bouncing contact made into presses: a level counts once it has stood still, a long press is reported while
// it is still held. Pure: levels and times in, presses out.
#pragma once

#include "hal/panel.h"

namespace touchline {

struct ButtonTiming {
  MonotonicNs debounce = 30 * one_millisecond;  // contacts bounce 5 to 20 ms
  MonotonicNs long_press = one_second;
};

class Button {
 public:
  explicit Button(const ButtonTiming& timing = {}) : timing_(timing) {}

  /// The level now; call it more often than the debounce time. ok: a press. not_ready: none.
  Result<ButtonEvent> update(bool pressed, MonotonicNs now) {
    if (pressed != raw_ || !started_) {
      // Held at start: not a press that anybody meant; it counts from the next release on.
      if (!started_) stable_ = pressed, long_reported_ = pressed;
      started_ = true;
      raw_ = pressed;
      raw_since_ = now;
    }
    if (raw_ != stable_ && now - raw_since_ >= timing_.debounce) return settle(now);
    if (stable_ && raw_ && !long_reported_ && now - pressed_since_ >= timing_.long_press) {
      long_reported_ = true;
      return ButtonEvent{now, ButtonPress::long_press};
    }
    return Status::not_ready;
  }
  void reset() { *this = Button(timing_); }

 private:
  Result<ButtonEvent> settle(MonotonicNs now) {
    stable_ = raw_;
    if (stable_) {
      pressed_since_ = raw_since_;
      long_reported_ = false;
      return Status::not_ready;
    }
    if (long_reported_) return Status::not_ready;
    return ButtonEvent{now, ButtonPress::short_press};
  }

  ButtonTiming timing_;
  bool started_ = false;
  bool raw_ = false;
  bool stable_ = false;
  bool long_reported_ = false;
  MonotonicNs raw_since_ = 0;
  MonotonicNs pressed_since_ = 0;
};

}  // namespace touchline
