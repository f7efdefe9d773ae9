// SPDX-License-Identifier: Apache-2.0
// The controller's end of a serial line, as plain as can be.
#pragma once

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

namespace touchline::vm {

/// Raw, 115200 baud; -1 when it cannot be opened.
inline int open_raw(const char* path) {
  const int file = ::open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (file < 0) return -1;
  termios settings{};
  tcgetattr(file, &settings);
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL;
  cfsetspeed(&settings, B115200);
  tcsetattr(file, TCSANOW, &settings);
  return file;
}

}  // namespace touchline::vm
