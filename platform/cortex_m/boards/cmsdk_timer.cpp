// SPDX-License-Identifier: Apache-2.0
// Instructions on the Arm MPS2 boards as QEMU has them, by the 32-bit CMSDK timer 0 at TIMER_HZ, which the board's file
// says: `-icount shift=5` lets 32 ns pass for an instruction, so that a tick of 25 MHz, 40 ns, is 5/4 of one. (A board
// of silicon would read DWT->CYCCNT, and get cycles.)
#include <cstdint>
#include <ratio>

#include "platform/cortex_m/board.h"

namespace touchline::board {
namespace {

constexpr std::uintptr_t timer = 0x40000000U;
volatile std::uint32_t& reg(std::uintptr_t offset) {
  return *reinterpret_cast<volatile std::uint32_t*>(timer + offset);
}
volatile std::uint32_t& control = reg(0x0);
volatile std::uint32_t& value = reg(0x4);
volatile std::uint32_t& reload = reg(0x8);

constexpr std::uint64_t instructions_per_second = 31'250'000;
using InstructionsPerTick = std::ratio<instructions_per_second, TIMER_HZ>;  // in lowest terms

}  // namespace

std::uint64_t instructions() {
  if (control == 0) {
    reload = 0xFFFFFFFFU;
    value = 0xFFFFFFFFU;
    control = 1;  // counts down, no interrupt
  }
  constexpr std::uint64_t numerator = InstructionsPerTick::num, denominator = InstructionsPerTick::den;
  return std::uint64_t{0xFFFFFFFFU - value} * numerator / denominator;  // wraps after some minutes
}

}  // namespace touchline::board
