// SPDX-License-Identifier: Apache-2.0
// What the program asks of the machine it runs on: the seam between playback, which runs everywhere, and start-up code.
#pragma once

#include <cstddef>
#include <cstdint>

namespace touchline::board {

/// Prints text as it is; no line end is added.
void print(const char* text);
/// Instructions since some moment, by a free-running counter; differences of two readings count. 0 where there is none.
std::uint64_t instructions();
/// Bytes of stack that were in use at the deepest point since start-up, by the paint that is left; 0 where none is
/// painted.
std::size_t stack_used();
std::size_t stack_size();

}  // namespace touchline::board
