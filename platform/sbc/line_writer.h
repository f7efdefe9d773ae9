// SPDX-License-Identifier: Apache-2.0
// Whole lines to a file descriptor that other programs share: a terminal, a pipe, a socket or a file. Never waits. A
// line that is cut in the middle (the disk is full, a terminal takes the half) is finished before the next one begins.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace touchline::sbc {

class LineWriter {
 public:
  /// `descriptor` stays the caller's and has to outlive the writer; < 0: none, and every line goes nowhere.
  explicit LineWriter(int descriptor);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// 0: the line is out, or its beginning is and its rest is kept. Else errno of what stood in the way, and nothing of
  /// it was written; EAGAIN: the reader is too slow. Needs SIGPIPE and SIGXFSZ to be ignored.
  int write(std::string_view line);
  [[nodiscard]] bool used() const { return descriptor_ >= 0; }
  /// Nobody will ever read again (a closed pipe, a descriptor that was closed at start); write() then says so for good.
  [[nodiscard]] bool closed() const { return gone_ != 0; }

 private:
  static constexpr std::size_t longest_line = 4096;  // of a report, and what a pipe takes undivided (PIPE_BUF)

  void use_terminal(int descriptor);
  int finish_last();
  long send(const char* bytes, std::size_t size) const;

  int descriptor_;
  bool own_ = false;           // opened here, to be closed here
  bool is_socket_ = false;     // is written by send(), which can be told not to wait
  bool ask_first_ = false;     // a pipe that could not be opened anew
  bool was_blocking_ = false;  // a terminal that could not be opened anew: set back at the end
  int gone_ = 0;               // EPIPE or EBADF
  std::array<char, longest_line> rest_{};
  std::size_t rest_size_ = 0;
};

}  // namespace touchline::sbc
