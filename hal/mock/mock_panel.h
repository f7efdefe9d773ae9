// SPDX-License-Identifier: Apache-2.0
// A panel whose button a test presses and whose light it reads.
#pragma once

#include <vector>

#include "hal/mock/script.h"
#include "hal/panel.h"

namespace touchline {

/// Scripted button, recorded light.
class MockPanel final : public Panel {
 public:
  Script<ButtonEvent> presses{Status::not_ready};
  OpenScript opens;
  std::vector<LedPattern> shown;  // every change of the pattern, in order

  [[nodiscard]] LedPattern pattern() const { return shown.empty() ? LedPattern::off : shown.back(); }

 private:
  Status do_open() override {
    if (health_.open) return Status::ok;
    const Status status = opens.next();
    health_.open = status == Status::ok;
    if (health_.open) ++health_.opened;
    if (!health_.open) health_.last_error = status;
    return status;
  }
  void do_close() override { health_.open = false; }
  Result<ButtonEvent> do_poll(MonotonicNs now) override {
    if (!health_.open) return Status::disconnected;
    const Result<ButtonEvent> press = presses.next();
    if (press.ok()) {
      ++health_.received;
      health_.last_datum = now;
    } else if (press.status() == Status::disconnected) {
      health_.last_error = press.status();
      do_close();
    }
    return press;
  }
  void do_show(LedPattern pattern) override {
    if (pattern != this->pattern()) shown.push_back(pattern);
  }
  DeviceHealth do_health() const override { return health_; }

  DeviceHealth health_;
};

}  // namespace touchline
