// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/fault_log.h"

#include <cstdio>

namespace touchline::sbc {

bool FaultLog::has_room(MonotonicNs now) {
  if (!started_ || now - window_ >= period) {
    started_ = true;
    window_ = now;
    in_window_ = 0;
  }
  if (in_window_ == burst) return false;
  ++in_window_;
  return true;
}

void FaultLog::say(std::string_view what, std::string_view subject, std::string_view detail) {
  char text[800];
  int size = std::snprintf(text, sizeof text, "touchline: %.*s%.*s%s%.*s", static_cast<int>(what.size()), what.data(),
                           static_cast<int>(subject.size()), subject.data(), detail.empty() ? "" : ": ",
                           static_cast<int>(detail.size()), detail.data());
  if (size < 0) return;
  auto length = static_cast<std::size_t>(size) < sizeof text - 60 ? static_cast<std::size_t>(size) : sizeof text - 60;
  size = left_out_ > 0 ? std::snprintf(text + length, sizeof text - length, " (%u lines left out)\n", left_out_)
                       : std::snprintf(text + length, sizeof text - length, "\n");
  left_out_ = 0;
  if (size > 0) length += static_cast<std::size_t>(size);
  (void)writer_.write({text, length});  // a log that cannot be written must not stop the robot
}

}  // namespace touchline::sbc
