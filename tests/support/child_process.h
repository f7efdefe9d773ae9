// SPDX-License-Identifier: Apache-2.0
// A program run by a test, with its two outputs in pipes (or in a file). Every wait has a deadline, and ends as soon as
// something happens.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace touchline::test {

class ChildProcess {
 public:
  /// Starts `command`; its standard output goes to the descriptor `out`, or, when that is < 0, to output().
  explicit ChildProcess(const std::vector<std::string>& command, int out = -1);
  /// Kills it if it still runs.
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  [[nodiscard]] bool started() const { return pid_ > 0; }
  void send(int signal) const;
  /// Takes what it writes, for at most so long; true when there was something.
  bool collect(int milliseconds);
  /// Collects until `text` stands in log() (standard error); false at the deadline.
  bool wait_for_log(const std::string& text, int milliseconds);
  /// Collects until so many whole lines stand in output().
  bool wait_for_lines(std::size_t lines, int milliseconds);
  /// Its exit status (negative: the signal that ended it), or nothing when it still runs at the deadline.
  std::optional<int> wait_for_end(int milliseconds);

  [[nodiscard]] const std::string& output() const { return text_[0]; }
  [[nodiscard]] const std::string& log() const { return text_[1]; }
  /// Takes the oldest whole line from output().
  std::optional<std::string> take_line();

 private:
  template <typename Condition>
  bool wait_until(const Condition& condition, int milliseconds);

  pid_t pid_ = -1;
  int process_ = -1;  // readable once it has ended
  int pipes_[2] = {-1, -1};
  std::string text_[2];
  std::optional<int> status_;
};

}  // namespace touchline::test
