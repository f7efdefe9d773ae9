// SPDX-License-Identifier: Apache-2.0
#include "platform/cortex_m/semihosting.h"

#include <cstdint>

#include "platform/cortex_m/board.h"

namespace touchline::board {
namespace {

constexpr std::uint32_t sys_write0 = 0x04;         // a zero-terminated text
constexpr std::uint32_t sys_exit_extended = 0x20;  // a reason and a status
constexpr std::uint32_t application_exit = 0x20026;

void call(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

}  // namespace

void print(const char* text) { call(sys_write0, text); }

void leave(int status) {
  const std::uint32_t block[2] = {application_exit, static_cast<std::uint32_t>(status)};
  call(sys_exit_extended, block);
  for (;;) {
  }
}

}  // namespace touchline::board
