// SPDX-License-Identifier: Apache-2.0
// One line of text that says what went wrong with a device, kept without the heap: devices fail and come back at run
// time.
#pragma once

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace touchline {

class Problem {
 public:
  /// Empty when nothing went wrong. Longer texts are cut at 199 characters.
  [[nodiscard]] const char* text() const { return text_; }
  void clear() { text_[0] = '\0'; }

  [[gnu::format(printf, 2, 3)]] void set(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text_, sizeof text_, format, arguments);
    va_end(arguments);
  }
  /// "`what` `path`: " and the text of errno.
  void set_errno(const char* what, const char* path) {
    const int error = errno;
    set("%s %s: %s", what, path, std::strerror(error));
    errno = error;
  }

 private:
  char text_[200] = {};
};

}  // namespace touchline
