// SPDX-License-Identifier: Apache-2.0
// What a scripted device answers, call after call; shared by all mocks of this folder.
#pragma once

#include <cstddef>
#include <deque>

#include "platform/core/result.h"

namespace touchline {

template <typename T>
class Script {
 public:
  /// `when_done` is the answer once the script has been played.
  explicit Script(Status when_done) : when_done_(when_done) {}

  void add(const T& value) { steps_.push_back(Result<T>(value)); }
  void add(Status failure, std::size_t times = 1) { steps_.insert(steps_.end(), times, Result<T>(failure)); }
  void when_done(Status status) { when_done_ = status; }

  Result<T> next() {
    if (steps_.empty()) return when_done_;
    const Result<T> step = steps_.front();
    steps_.pop_front();
    return step;
  }
  [[nodiscard]] std::size_t left() const { return steps_.size(); }

 private:
  std::deque<Result<T>> steps_;
  Status when_done_;
};

/// The script of open(): ok unless a test says otherwise.
class OpenScript {
 public:
  void add(Status answer, std::size_t times = 1) { steps_.insert(steps_.end(), times, answer); }
  Status next() {
    if (steps_.empty()) return Status::ok;
    const Status step = steps_.front();
    steps_.pop_front();
    return step;
  }

 private:
  std::deque<Status> steps_;
};

}  // namespace touchline
