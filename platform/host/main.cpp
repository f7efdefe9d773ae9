// SPDX-License-Identifier: Apache-2.0
// The program `touchline`.
#include <iostream>

#include <unistd.h>

#include "platform/host/command_line.h"

int main(int argc, char** argv) {
  return touchline::host::touchline_main(argc, argv, std::cout, std::cerr, ::isatty(1) != 0);
}
