// SPDX-License-Identifier: Apache-2.0
// The program `touchline`.
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

#include "platform/host/command_line.h"

namespace {

/// Descriptors 0 to 2 that were closed at start would be given to the first files opened, and a serial port would get
/// what is printed. /dev/null takes their places, opened for the other direction, so that writing is still an error.
void keep_standard_descriptors() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    if (::open("/dev/null", descriptor == 0 ? O_WRONLY : O_RDONLY) != descriptor) return;  // the lowest that is free
  }
}

}  // namespace

int main(int argc, char** argv) {
  keep_standard_descriptors();
  return touchline::host::touchline_main(argc, argv, std::cout, std::cerr, ::isatty(1) != 0);
}
