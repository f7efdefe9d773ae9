// SPDX-License-Identifier: Apache-2.0
// The program `touchline`.
#include <iostream>

#include "platform/host/command_line.h"

int main(int argc, char** argv) { return touchline::host::touchline_main(argc, argv, std::cout, std::cerr); }
