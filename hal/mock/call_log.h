// SPDX-License-Identifier: Apache-2.0
// What a recording device was asked, in order.
#pragma once

#include <string_view>
#include <vector>

#include "platform/core/status.h"

namespace touchline {

struct Call {
  std::string_view name;  // "open", "close", "acquire", "release", "read", "poll", "show"
  Status answer = Status::ok;
};

class CallLog {
 public:
  void add(std::string_view name, Status answer = Status::ok) { calls_.push_back({name, answer}); }
  [[nodiscard]] const std::vector<Call>& calls() const { return calls_; }
  [[nodiscard]] int count(std::string_view name) const {
    int found = 0;
    for (const Call& call : calls_) found += call.name == name ? 1 : 0;
    return found;
  }

 private:
  std::vector<Call> calls_;
};

}  // namespace touchline
