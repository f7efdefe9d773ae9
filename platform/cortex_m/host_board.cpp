// SPDX-License-Identifier: Apache-2.0
// The host as a board: prints to standard output and counts nothing. What it prints is what each board has to print.
#include <cstdio>

#include "platform/cortex_m/board.h"

namespace touchline::board {

void print(const char* text) { std::fputs(text, stdout); }
std::uint64_t instructions() { return 0; }
std::size_t stack_used() { return 0; }
std::size_t stack_size() { return 0; }

}  // namespace touchline::board

extern "C" int run_program();
int main() { return run_program(); }
