// SPDX-License-Identifier: Apache-2.0
// The robot's panel: one button and one light.
#pragma once

#include <cstdint>

#include "hal/device_health.h"
#include "platform/core/result.h"
#include "platform/core/time.h"

namespace touchline {

enum class ButtonPress : std::uint8_t {
  short_press,  // store the present yaw as the goal's yaw
  long_press,   // localize from nothing
};

struct ButtonEvent {
  MonotonicNs time = 0;  // short: of the release; long: when it had been held long enough
  ButtonPress press = ButtonPress::short_press;
};

enum class LedPattern : std::uint8_t {
  off,
  no_camera,  // two short flashes a second
  searching,  // slow blinking, once a second
  sure,       // on
  fault,      // fast blinking, five times a second
};

/// Whether the light is on at `time` in the pattern: the same rule for every backend.
constexpr bool led_is_on(LedPattern pattern, MonotonicNs time) {
  const MonotonicNs ms = (time / one_millisecond) % 1000;
  switch (pattern) {
    case LedPattern::off: return false;
    case LedPattern::no_camera: return ms < 100 || (ms >= 200 && ms < 300);
    case LedPattern::searching: return ms < 500;
    case LedPattern::sure: return true;
    case LedPattern::fault: return ms % 200 < 100;
  }
  return false;
}

/// Not thread safe. poll() never blocks and never allocates.
class Panel {
 public:
  virtual ~Panel() = default;

  /// Already open: ok. disconnected: no such chip or line (yet). device_error: the system refused.
  Status open() { return do_open(); }
  void close() { do_close(); }

  /// Drives the light and debounces the button; call it at least every 50 ms. Returns the oldest press not reported
  /// yet. not_ready: none. disconnected: not open or gone. device_error: the system refused.
  Result<ButtonEvent> poll(MonotonicNs now) { return do_poll(now); }
  /// The pattern from now on; poll() plays it. Never fails: a panel that is gone simply stays dark.
  void show(LedPattern pattern) { do_show(pattern); }

  [[nodiscard]] DeviceHealth health() const { return do_health(); }

 private:
  virtual Status do_open() = 0;
  virtual void do_close() = 0;
  virtual Result<ButtonEvent> do_poll(MonotonicNs now) = 0;
  virtual void do_show(LedPattern pattern) = 0;
  virtual DeviceHealth do_health() const = 0;
};

}  // namespace touchline
