// SPDX-License-Identifier: Apache-2.0
// From reset to main() on a Cortex-M with no operating system (Armv7-M and Armv8-M reference manuals: vector table,
// CPACR, CFSR). The linker script gives the symbols.
#include <cstddef>
#include <cstdint>

#include "platform/cortex_m/board.h"
#include "platform/cortex_m/semihosting.h"
#include "platform/cortex_m/text.h"

extern "C" {
int run_program();  // main.cpp; a program may not call main
extern std::uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[], stack_bottom[], stack_top[];
extern void (*init_array_start[])();
extern void (*init_array_end[])();
void reset_handler();
void fault_handler();
}

namespace {

using Handler = void (*)();
constexpr std::uint32_t paint = 0xA5C3A5C3U;
constexpr int fault_status = 97;

volatile std::uint32_t& reg(std::uintptr_t address) { return *reinterpret_cast<volatile std::uint32_t*>(address); }

void enable_fpu() {
  reg(0xE000ED88U) |= 0xFU << 20U;  // CPACR: full access to coprocessors 10 and 11
  asm volatile("dsb\n isb" ::: "memory");
}

/// Everything below the stack pointer; what a call overwrites later shows how deep it went.
void paint_stack() {
  std::uint32_t* here = nullptr;
  asm volatile("mov %0, sp" : "=r"(here));
  for (std::uint32_t* p = stack_bottom; p < here - 8; ++p) *p = paint;
}

}  // namespace

// NOLINTNEXTLINE: the processor reads it, no C++ does
extern "C" __attribute__((section(".vectors"), used)) const Handler vectors[16] = {reinterpret_cast<Handler>(stack_top),
                                                                                   reset_handler,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   nullptr,
                                                                                   nullptr,
                                                                                   nullptr,
                                                                                   fault_handler,
                                                                                   fault_handler,
                                                                                   nullptr,
                                                                                   fault_handler,
                                                                                   fault_handler};

extern "C" __attribute__((noreturn)) void run_after_reset();

// No prologue: the compiler may save floating-point registers only once the unit is on.
extern "C" __attribute__((naked)) void reset_handler() { asm volatile("b run_after_reset"); }

// "used": named by assembler text alone, which the link-time optimiser does not read.
extern "C" [[gnu::used]] void run_after_reset() {
  enable_fpu();
  const std::uint32_t* from = data_load;
  for (std::uint32_t* to = data_start; to < data_end;) *to++ = *from++;
  for (std::uint32_t* to = bss_start; to < bss_end;) *to++ = 0;
  paint_stack();
  for (auto* start = init_array_start; start < init_array_end; ++start) (*start)();
  touchline::board::leave(run_program());
}

extern "C" __attribute__((noreturn)) void report_fault(const std::uint32_t* stack_pointer);

// Nobody goes back from here, and the fault may be that the stack is at its end: its memory is used anew.
extern "C" __attribute__((naked)) void fault_handler() {
  asm volatile("mov r0, sp\n ldr r1, =stack_top\n mov sp, r1\n b report_fault");
}

extern "C" [[gnu::used]] void report_fault(const std::uint32_t* stack_pointer) {
  using touchline::board::print;
  using touchline::board::Text;
  print(
      Text().add("fault: CFSR ").add_hex(reg(0xE000ED28U)).add(", BFAR ").add_hex(reg(0xE000ED38U)).add("\n").c_str());
  if (stack_pointer < stack_bottom)
    print("the stack ran over its end: raise stack_bytes in the board's linker script\n");
  touchline::board::leave(fault_status);
}

namespace touchline::board {

std::size_t stack_size() {
  return static_cast<std::size_t>(reinterpret_cast<char*>(stack_top) - reinterpret_cast<char*>(stack_bottom));
}

std::size_t stack_used() {
  const std::uint32_t* p = stack_bottom;
  while (p < stack_top && *p == paint) ++p;
  return static_cast<std::size_t>(stack_top - p) * sizeof(std::uint32_t);
}

}  // namespace touchline::board
